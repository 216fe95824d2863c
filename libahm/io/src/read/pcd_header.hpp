/// \file
/// The header of a PCD file. It is checked against the file before PCL reads the file.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "read/bytes.hpp"
#include "read/input.hpp"
#include "read/text.hpp"

namespace ahm::io {

enum class PcdData { ascii, binary, compressed };

struct PcdField {
  std::string name;
  char type = 'F';          ///< F: float, I: signed integer, U: unsigned integer
  std::uint64_t size = 4;   ///< bytes of one value
  std::uint64_t count = 1;  ///< values per point
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t width = 0, height = 0;
  std::uint64_t points = 0;  ///< width * height
  /// Pose of the sensor: x, y, z, and a quaternion w, x, y, z.
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  std::uint64_t point_size = 0;  ///< bytes of one point
  PcdData data = PcdData::ascii;
  std::size_t body = 0;        ///< position of the first byte after the header
  std::int64_t body_line = 0;  ///< number of the first line after the header
  SkippedLines skipped;        ///< lines of the header, and of text, without a meaning
};

/// Reads the header, and checks that fields and counts are consistent. Fields of no values (COUNT 0) are left out, and so is padding
/// that compressed data does not contain. @throws IoError with the line
PcdHeader parse_pcd_header(const Input& in);
/// Checks that a file of uncompressed binary points is long enough for the number of points; if the header has unknown lines, exactly
/// as long, because these could be damaged fields. @throws IoError with the byte
void check_pcd_size(const Input& in, const PcdHeader& header);

/// Reads the points of a text file, and checks that each line has as many numbers as the fields have values.
/// @param use  receives the words of each line
/// @throws IoError with the line
void read_pcd_text(const Input& in, const PcdHeader& header, Lines& lines,
                   const std::function<void(const std::vector<std::string_view>&)>& use);
/// Compressed and uncompressed size of the data, bytes, from the beginning of compressed data.
/// @throws IoError with the byte, if they are inconsistent with the header or the file size
std::array<std::uint32_t, 2> pcd_sizes(const Input& in, const PcdHeader& header);

/// A checked PCD file, safe to pass to other readers.
struct CheckedPcd {
  PcdHeader header;
  std::string text;  ///< text files: one line per point, with single blanks, which all readers accept
};

/// Reads the header and checks everything that a PCD reader relies on: consistency of fields, counts and the file size, the sizes of
/// compressed data, and in text files every line and word.
/// @throws IoError with the line or byte
CheckedPcd check_pcd(const Input& in);

/// The header as text of a PCD file, with all entries.
std::string full_header(const PcdHeader& header);

}  // namespace ahm::io
