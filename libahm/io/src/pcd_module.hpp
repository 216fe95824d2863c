/// \file
/// PCD files read through PCL, as a module: PCL's reader brings VTK along, which nobody should wait for who has no PCD file.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// What the module pcd offers, under the name ahm_pcd.
struct PcdFunctions {
  Geometry (*read)(const Input& in);
};

}  // namespace ahm::io
