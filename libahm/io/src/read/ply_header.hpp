/// \file
/// The header of a PLY file: elements and their properties, checked against the file size.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read/input.hpp"
#include "read/skipped_lines.hpp"

namespace ahm::io {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one value.
std::size_t size_of(PlyType type) noexcept;
bool is_whole(PlyType type) noexcept;
/// Whether doubles represent all values of the type exactly; integers of 64 bits may be too large.
inline bool is_exact(PlyType type) noexcept { return type != PlyType::int64 && type != PlyType::uint64; }
/// Doubles represent all smaller whole numbers exactly.
constexpr double least_inexact = 9007199254740992;  // 2^53

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< type of the value, or of the values of a list
  std::optional<PlyType> count_type;  ///< type of the count of a list; nullopt: not a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::int64_t line = 0;  ///< number of the header line that declares the element

  /// Index of the first property with this name, ignoring case; nullopt if there is none. @param property  in lower case
  std::optional<std::size_t> find(std::string_view property) const;
  bool has_list() const noexcept;
  /// Bytes of one item when every list is empty.
  std::size_t fixed_size() const noexcept;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  SkippedLines skipped;        ///< lines without a meaning, where they cannot be damaged properties of binary data
  std::size_t body = 0;        ///< position of the first byte after the header
  std::int64_t body_line = 0;  ///< number of the first line after the header
};

/// @throws IoError with the line
PlyHeader parse_ply_header(const Input& in);

/// Whether the byte order of the file differs from the byte order of the memory.
inline bool is_swapped(PlyFormat format) noexcept {
  return (format == PlyFormat::big_endian) != (std::endian::native == std::endian::big);
}

template <class T>
double load_as(const char* bytes, bool swap) noexcept {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::ranges::reverse(raw);
  return static_cast<double>(std::bit_cast<T>(raw));
}

inline double load_value(PlyType type, const char* bytes, bool swap) noexcept {
  switch (type) {
    case PlyType::int8:
      return load_as<std::int8_t>(bytes, swap);
    case PlyType::uint8:
      return load_as<std::uint8_t>(bytes, swap);
    case PlyType::int16:
      return load_as<std::int16_t>(bytes, swap);
    case PlyType::uint16:
      return load_as<std::uint16_t>(bytes, swap);
    case PlyType::int32:
      return load_as<std::int32_t>(bytes, swap);
    case PlyType::uint32:
      return load_as<std::uint32_t>(bytes, swap);
    case PlyType::int64:
      return load_as<std::int64_t>(bytes, swap);
    case PlyType::uint64:
      return load_as<std::uint64_t>(bytes, swap);
    case PlyType::float32:
      return load_as<float>(bytes, swap);
    case PlyType::float64:
      return load_as<double>(bytes, swap);
  }
  return 0.0;
}

}  // namespace ahm::io
