/// \file
/// The header of a PLY file: elements with their properties, checked against the size of the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read/input.hpp"

namespace ahm::io {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value.
std::size_t size_of(PlyType type) noexcept;
bool is_whole(PlyType type) noexcept;

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of the value, or of a list's values
  std::optional<PlyType> count_type;  ///< set for a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::int64_t line = 0;  ///< where the header declares it

  /// Position of the first property with this name (lower case) in any case of its letters, nullopt when there is none.
  std::optional<std::size_t> find(std::string_view property) const;
  bool has_list() const noexcept;
  /// Bytes of one item when every list is empty.
  std::size_t fixed_size() const noexcept;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t ignored_lines = 0;  ///< that have no meaning; text, or before the first element
  std::size_t body = 0;           ///< position of the first byte behind the header
  std::int64_t body_line = 0;     ///< number of the first line behind the header
};

/// @throws IoError naming the line
PlyHeader parse_ply_header(const Input& in);

}  // namespace ahm::io
