/// \file
/// How many points a thread takes at a time.
#pragma once

#include "ahm/types.hpp"

namespace ahm::pointcloud {

inline constexpr Offset points_per_task = 4096;

}  // namespace ahm::pointcloud
