/// \file
/// The part of a cloud around a point: all that a map of limited radius needs, however large the scan.
///
/// \code
/// auto near = ahm::pointcloud::surroundings(points, normals, points[7], 1.5 * radius);
/// auto cloud = ahm::pointcloud::PointCloudGraph::build(near.points, near.normals);
/// ahm::LogMap map = ahm::LogMapSolver(cloud.graph()).solve(cloud.source_at_point(near.place_of(7)), {.radius = radius});
/// // row i of the map belongs to points[near.index[i]]
/// \endcode
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

struct Surroundings {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< empty, or one per point
  std::vector<Index> index;   ///< of each point in the whole cloud, ascending

  /// Where a point of the whole cloud stands here, -1 where it is not among these.
  Index place_of(Index point) const {
    const auto at = std::lower_bound(index.begin(), index.end(), point);
    return at != index.end() && *at == point ? static_cast<Index>(at - index.begin()) : -1;
  }
};

/// The points within a straight distance of `center`; points that are not finite are none. A path along the surface is never
/// shorter than the straight distance, so that everything within `radius` along the surface is there; take half as
/// much again, since the diffusion time is that of the points kept and their border shows.
/// @param normals  empty, or one per point
Surroundings surroundings(std::span<const Vec3> points, std::span<const Vec3> normals, const Vec3& center,
                          double radius);

}  // namespace ahm::pointcloud
