/// \file
/// Reader of PCD files through PCL, as a module that is loaded on demand: PCL's reader also loads VTK, which slows down startup.
#pragma once

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Functions of the module pcd, which exports them as `ahm_pcd`.
struct PcdFunctions {
  Geometry (*read)(const Input& in);
};

}  // namespace ahm::io
