/// \file
/// PCL's k-d tree as a neighbor search of the point cloud backend.
///
/// \code
/// ahm::pointcloud::CloudOptions options;
/// options.search = ahm::pcl_bridge::kdtree_search;
/// auto cloud = ahm::pointcloud::PointCloudSurface::build(points, {}, options);
/// \endcode
#pragma once

#include <memory>
#include <span>
#include <string>

#include "ahm/pointcloud/neighbor_search.hpp"

namespace ahm::pcl_bridge {

/// `pcl::KdTreeFLANN` as a `NeighborSearch`.
///
/// PCL stores points in single precision. Points are therefore translated to the middle of their bounding box and divided by a
/// power of two before the conversion. A cloud far from the origin then keeps its shape to 2^-24 of its size. Distances are
/// recomputed in double precision, and neighbors sorted by them. The points found may differ from an exact search only where
/// distances agree to about 1e-7 of the size of the cloud.
/// @throws InvalidGeometry (a coordinate is not finite, with its index)
std::unique_ptr<pointcloud::NeighborSearch> kdtree_search(std::span<const Vec3> points);

/// Version of PCL at compile time, e.g. "1.13.0".
std::string version();

}  // namespace ahm::pcl_bridge
