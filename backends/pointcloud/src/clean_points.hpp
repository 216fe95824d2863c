/// \file
/// Removal of invalid and duplicate points.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::pointcloud {

/// The power of two that brings input points to lengths of order one. Points are not translated: differences of points remain
/// those of the input, to the last bit, whatever else the file contains.
struct Placement {
  int exponent = 0;  ///< exponent of the median distance (largest coordinate difference) from the coordinates' medians
  Vec3 place(const Vec3& point) const;
  /// Length in the input per length of placed points.
  double unit() const;
};

/// Whether a point lies before another one on the Morton curve through all of space. The order of two finite points depends
/// only on these points, and scaling by a power of two does not change it.
bool before_on_curve(const Vec3& point, const Vec3& other);

/// Distinct points in the order of the Morton curve, and their indices in the input.
struct CleanPoints {
  std::vector<Vec3> points;           ///< distinct points, in units of `unit`
  std::vector<Index> input;           ///< index of the first input point at each point
  std::vector<Index> clean_of_input;  ///< point of each input point; -1: dropped
  std::vector<char> smoothed;         ///< whether the point lies in noise that was smoothed; empty: no smoothing
  double unit = 1.0;                  ///< length unit of the points, a power of two
};

/// Drops points that are not finite and merges equal ones; counts both in `report`. Scaling the input by a power of two changes
/// only `unit`.
/// @param row  returns the number of a point in the input, for messages
/// @throws InvalidGeometry
CleanPoints clean_points(std::span<const Vec3> points, const std::function<Index(std::size_t)>& row,
                         const CloudOptions& options, CloudDetails& report);

}  // namespace ahm::pointcloud
