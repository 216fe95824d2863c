/// \file
/// Text files with columns of numbers, and conversion of numbers to colors.
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

/// Converts red, green, blue to bytes. The values are fractions of 1 (if none exceeds 1), else whole levels up to 255, else, if
/// `deep`, whole levels up to 65535. nullopt for other values.
std::optional<std::vector<Color>> to_colors(const std::vector<Vec3>& values, bool deep = false);

/// Adds a property. Changes its name if necessary: only letters, digits and _, and different from other names.
void add_property(Geometry& g, const std::string& name, std::vector<double> values);

/// Differences between the formats that cannot be detected in a file.
struct ColumnDialect {
  const char* format;                ///< name of the format, for messages
  bool tabs_separate = false;        ///< every tab ends a column, possibly an empty one; else tabs are blanks
  bool fourth_is_intensity = false;  ///< if there are four columns, or seven, of which the last are red green blue
};

/// Reads columns separated by semicolons, commas or blanks, the same separator in the whole file. A line with the names of the
/// columns may come first (also after //). A line with a single number begins a block of so many points.
/// @throws IoError with the line
Geometry read_columns(const Input& in, const ColumnDialect& dialect);
/// Reads columns like `read_columns`, but only passes the points to `take`. @return whether they have normals
bool take_columns(const ByteStream& file, const ColumnDialect& dialect, const TakePoint& take);

}  // namespace ahm::io
