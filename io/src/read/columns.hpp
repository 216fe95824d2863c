/// \file
/// Points as columns of numbers.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Columns separated by blanks.
Geometry read_blank_separated(const Input& in);
/// Columns separated by commas, semicolons or tabs, perhaps with names in the first line.
Geometry read_delimited(const Input& in);

}  // namespace ahm::io
