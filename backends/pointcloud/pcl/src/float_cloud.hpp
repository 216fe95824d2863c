/// \file
/// Conversion of points for PCL: single precision, around the origin, of order one.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <span>
#include <string_view>

#include "ahm/types.hpp"

namespace ahm::pcl_bridge {

/// A cloud in single precision, transformed by p -> (p - center) / unit.
struct FloatCloud {
  ::pcl::PointCloud<::pcl::PointXYZ>::Ptr cloud;
  Vec3 center;  ///< middle of the bounding box
  double unit;  ///< power of two that brings the largest coordinate into (0.5, 1]
  Vec3 extent;  ///< size of the bounding box, in units of `unit`

  ::pcl::PointXYZ convert(const Vec3& p) const {
    return {static_cast<float>((p[0] - center[0]) / unit), static_cast<float>((p[1] - center[1]) / unit),
            static_cast<float>((p[2] - center[2]) / unit)};
  }
};

/// Converts a cloud.
/// @param caller  name of the public function, for messages
/// @throws InvalidGeometry (a coordinate is not finite; the message contains its index)
FloatCloud to_float_cloud(std::span<const Vec3> points, std::string_view caller);

}  // namespace ahm::pcl_bridge
