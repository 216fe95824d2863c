/// \file
/// The part of a cloud around a point: all that a map of limited radius needs, however large the scan.
///
/// \code
/// ahm::pointcloud::CloudOptions options{.rows = ahm::pointcloud::radius_search(points, points[7], 1.5 * radius)};
/// auto cloud = ahm::pointcloud::PointCloudSurface::build(points, normals, options);
/// ahm::LogMap map = ahm::LogMapSolver(cloud.graph()).solve(cloud.source(ahm::Row{7}).source, {.radius = radius});
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

/// The points within a straight distance of `center`, ascending; points that are not finite are none. A path along the
/// surface is never shorter than the straight distance, so that everything within `radius` along the surface is there;
/// take half as much again, since the diffusion time is that of the points kept and their border shows.
std::vector<Row> radius_search(std::span<const Vec3> points, const Vec3& center, double radius);

}  // namespace ahm::pointcloud
