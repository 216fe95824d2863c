/// \file
/// Input points made ready for geometry: finite, distinct, of order one, in an order that keeps neighbours close in
/// memory.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::pointcloud {

/// How input points are brought to order one about their middle.
struct Placement {
  int first = 0;         ///< exponent of the largest coordinate
  Vec3 middle{0, 0, 0};  ///< medians of the coordinates, in units of 2^first
  int second = 0;        ///< exponent of the median distance from there, largest coordinate, in these units
  Vec3 place(const Vec3& point) const;
  /// Power of two: input lengths per length of placed points.
  double unit() const;
};

/// Position along the Morton curve through [-16, 16]^3; points beyond count as on its faces.
std::uint64_t morton_code(const Vec3& placed);

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
