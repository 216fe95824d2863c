/// \file
/// Reads PCD files with PCL. Does not include PCL's headers.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

Geometry read_pcd(const Input& in);

}  // namespace ahm::io
