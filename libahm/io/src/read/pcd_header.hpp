/// \file
/// The header of a PCD file, checked against the file before PCL sees it.
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
  char type = 'F';          ///< F float, I signed, U unsigned
  std::uint64_t size = 4;   ///< bytes of one value
  std::uint64_t count = 1;  ///< values per point
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t width = 0, height = 0;
  std::uint64_t points = 0;  ///< width times height
  /// Of the sensor: x, y, z, and a quaternion w, x, y, z.
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  std::uint64_t point_size = 0;  ///< bytes of one point
  PcdData data = PcdData::ascii;
  std::size_t body = 0;        ///< position of the first byte behind the header
  std::int64_t body_line = 0;  ///< number of the first line behind the header
};

/// Reads the header and checks fields and counts against each other. @throws IoError naming the line
PcdHeader parse_pcd_header(const Input& in);
/// That a file of uncompressed binary points holds as many as its header says. @throws IoError naming the byte
void check_pcd_size(const Input& in, const PcdHeader& header);

/// The lines of a file of text, each as many numbers as fields have values. @throws IoError naming the line
void read_pcd_text(const Input& in, const PcdHeader& header, Lines& lines,
                   const std::function<void(const std::vector<std::string_view>&)>& use);
/// The compressed size and the uncompressed one, which stand at the beginning of compressed data.
/// @throws IoError naming the byte, where they do not fit the header or the file
std::array<std::uint32_t, 2> pcd_sizes(const Input& in, const PcdHeader& header);

/// What is safe to hand on.
struct CheckedPcd {
  PcdHeader header;
  std::string text;  ///< of a file of text, a line for each point: readers do not agree on other blanks than these
};

/// Reads the header and checks everything a PCD reader would have to believe: fields and counts against each other and
/// against the size of the file, the sizes of compressed data, and in text every line and word.
/// @throws IoError naming the line or byte
CheckedPcd check_pcd(const Input& in);

/// The header in full, as text of a PCD file: what a reader should make of it.
std::string full_header(const PcdHeader& header);

}  // namespace ahm::io
