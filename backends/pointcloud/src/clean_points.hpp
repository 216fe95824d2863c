/// \file
/// Input points made ready for geometry: finite, distinct, of order one, in an order that keeps neighbours close in
/// memory.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::pointcloud {

/// The power of two that brings input points to lengths of order one. Nothing is subtracted: differences of points are those
/// of the input, to the last bit, whatever else is in the file.
struct Placement {
  int exponent = 0;  ///< of the median distance from the medians of the coordinates, by the largest difference
  Vec3 place(const Vec3& point) const;
  /// Input lengths per length of placed points.
  double unit() const;
};

/// Whether one point lies before another on the Morton curve through all of space: an order of two finite points that
/// depends on nothing but them, and not on their scale, if that is a power of two.
bool before_on_curve(const Vec3& point, const Vec3& other);

struct CleanPoints {
  std::vector<Vec3> points;           ///< distinct, along the Morton curve, input / unit
  std::vector<Index> input;           ///< first input point at each
  std::vector<Index> clean_of_input;  ///< -1: dropped
  std::vector<char> smoothed;         ///< whether the point was in noise that was smoothed; empty: none
  double unit = 1.0;                  ///< power of two
};

/// Cleans, and counts what it drops and merges in `report`. Scaling by powers of two changes no bit of the result but
/// `unit`.
/// @param row  names a point, for messages
/// @throws InvalidGeometry
CleanPoints clean_points(std::span<const Vec3> points, const std::function<Index(std::size_t)>& row,
                         const CloudOptions& options, CloudDetails& report);

}  // namespace ahm::pointcloud
