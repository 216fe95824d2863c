/// \file
/// PCL's k-d tree as a neighbour search of the point cloud backend.
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

/// `pcl::KdTreeFLANN` behind the `NeighborSearch` interface.
///
/// PCL stores points in single precision: they are moved to the middle of their bounding box and divided by a power of
/// two before the conversion, so that a cloud far from the origin keeps its shape to 2^-24 of its size. Distances are
/// computed again in double precision and the neighbours sorted by them; which points are found may differ from an
/// exact search only where distances agree to about 1e-7 of the size of the cloud.
/// @throws InvalidGeometry (a coordinate is not finite, with its index)
std::unique_ptr<pointcloud::NeighborSearch> kdtree_search(std::span<const Vec3> points);

/// The version of PCL this library was compiled with, e.g. "1.13.0".
std::string version();

}  // namespace ahm::pcl_bridge
