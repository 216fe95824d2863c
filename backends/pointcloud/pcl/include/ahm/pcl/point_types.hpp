/// \file
/// A PCL point type that contains a log map. It is registered with PCL and can be saved, filtered and converted like PCL's own.
///
/// \code
/// pcl::io::savePCDFileBinary("map.pcd", ahm::pcl_bridge::to_pcl(*cloud, map));  // a pcl::PointCloud<ahm::pcl_bridge::PointLogMap>
/// \endcode
#pragma once

#include <pcl/pcl_macros.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

// Outside namespace ahm: PCL's macros use names in `pcl::`, which would mean ahm::pcl inside it.
namespace ahm_point_types {

/// Position, log map and status of a point, in single precision like all PCL points.
struct EIGEN_ALIGN16 PointLogMap {
  PCL_ADD_POINT4D
  float u;  ///< NaN where the status is not 0
  float v;
  float distance;
  float angle;
  std::uint32_t
      status;  ///< the number of the `ahm::Status`: 0 ok, 1 disconnected, 2 beyond_radius, 3 unreached, 4 removed
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace ahm_point_types

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(ahm_point_types::PointLogMap,
  (float, x, x)(float, y, y)(float, z, z)
  (float, u, u)(float, v, v)(float, distance, distance)(float, angle, angle)
  (std::uint32_t, status, status))
// clang-format on

namespace ahm::pcl_bridge {
using PointLogMap = ::ahm_point_types::PointLogMap;
}
