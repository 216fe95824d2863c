/// \file
/// The plane of a point and its neighbours.
///
/// \code
/// ahm::Vec3 normal = ahm::pointcloud::fit_plane(points, 7, neighbors).normal;    // neighbors: rows of points, 7 left out
/// \endcode
#pragma once

#include <span>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

struct PlaneFit {
  Vec3 normal{0, 0, 0};  ///< unit direction of least variance, either sign; zero where the points lie on a line
  Vec3 along{0, 0, 0};   ///< unit direction of most variance, either sign; zero likewise
  double ratio = 0;      ///< second principal variance / first
  double thickness = 0;  ///< third principal variance / second
};

/// By principal component analysis of point i and the neighbours.
PlaneFit fit_plane(std::span<const Vec3> points, Index i, std::span<const Index> neighbors);

}  // namespace ahm::pointcloud
