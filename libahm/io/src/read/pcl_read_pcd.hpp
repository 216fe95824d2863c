/// \file
/// PCD files through PCL, whose headers stay out of this one.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

Geometry read_pcd(const Input& in);

}  // namespace ahm::io
