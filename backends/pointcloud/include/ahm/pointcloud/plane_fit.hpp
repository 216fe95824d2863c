/// \file
/// The plane through a point and its neighbors.
///
/// \code
/// ahm::Vec3 normal = ahm::pointcloud::fit_plane(points, 7, neighbors).normal;    // neighbors: rows of points, without 7
/// \endcode
#pragma once

#include <span>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

/// The principal axes of a point and its neighbors.
struct PlaneFit {
  Vec3 normal{0, 0, 0};  ///< unit direction of least variance, either sign; zero if the points lie on a line
  Vec3 along{0, 0, 0};   ///< unit direction of most variance, either sign; zero if the points lie on a line
  double ratio = 0;      ///< second principal variance / first
  double thickness = 0;  ///< third principal variance / second
};

/// Fits a plane to point i and its neighbors by principal component analysis.
PlaneFit fit_plane(std::span<const Vec3> points, Index i, std::span<const Index> neighbors);

}  // namespace ahm::pointcloud
