/// \file
/// Which column holds what, by the names in a file's first line.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "read/input.hpp"

namespace ahm::io {

enum class ColumnRole { unknown, normals, colors };

struct ColumnNames {
  std::array<std::size_t, 3> position;  ///< of x, y, z
  std::vector<std::pair<ColumnRole, std::array<std::size_t, 3>>> triples;
};

/// Whether one of the words is "x", one "y" and one "z", in any case.
bool names_position(const std::vector<std::string_view>& words);

/// x y z; nx ny nz; red green blue, r g b, or rf gf bf; in any case and order, among others.
/// @throws IoError when one of x, y, z is missing, or a name that is read is there twice
ColumnNames find_columns(const Input& in, std::int64_t line, const std::vector<std::string_view>& words);

}  // namespace ahm::io
