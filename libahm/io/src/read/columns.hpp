/// \file
/// Colors that stand in a file as plain numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/types.hpp"
#include "read/input.hpp"
#include "read/point_stream.hpp"

namespace ahm::io {

using Color = std::array<std::uint8_t, 3>;

/// Red, green, blue as fractions of 1 (when none exceeds 1), else as whole levels up to 255, else, where `deep`, as whole
/// levels up to 65535. nullopt when they are none of these.
std::optional<std::vector<Color>> to_colors(const std::vector<Vec3>& values, bool deep = false);

/// Adds a property, under a name that a column may have (letters, digits and _) and that no other one has.
void add_property(Geometry& g, const std::string& name, std::vector<double> values);

/// What cannot be told from the file.
struct ColumnDialect {
  const char* format;                ///< for messages
  bool tabs_separate = false;        ///< every tab ends a column, perhaps an empty one; else it is a blank
  bool fourth_is_intensity = false;  ///< of four columns, and of seven, which end with red green blue
};

/// Columns separated by semicolons, commas or blanks, one of these in the whole file; perhaps names of the columns first
/// (also behind //), perhaps a line with the number of points, after which so many follow, and then another such block.
/// @throws IoError naming the line
Geometry read_columns(const Input& in, const ColumnDialect& dialect);
/// The same, of which points alone are kept. @return whether they have normals
bool take_columns(const ByteStream& file, const ColumnDialect& dialect, const TakePoint& take);

}  // namespace ahm::io
