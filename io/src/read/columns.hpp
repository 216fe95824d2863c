/// \file
/// Points as columns of numbers.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"
#include "read/point_records.hpp"

namespace ahm::io {

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
