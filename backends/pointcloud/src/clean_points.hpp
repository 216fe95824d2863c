/// \file
/// Input points made ready for geometry: finite, distinct, of order one, in an order that keeps neighbours close in
/// memory.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::pointcloud {

struct CleanPoints {
  std::vector<Vec3> points;           ///< distinct, along a Morton curve, (input - center) / unit
  std::vector<Index> input;           ///< first input point at each
  std::vector<Index> clean_of_input;  ///< -1: dropped
  double unit = 1.0;                  ///< power of two
};

/// Cleans, and counts what it drops and merges in `report`. Scaling by powers of two changes no bit of the result but
/// `unit`.
/// @param row  names a point, for messages
/// @throws InvalidGeometry
CleanPoints clean_points(std::span<const Vec3> points, const std::function<Index(std::size_t)>& row,
                         const CloudOptions& options, CloudDetails& report);

}  // namespace ahm::pointcloud
