/// \file
/// Neighbours and tangent planes of the points of a cloud.
#pragma once

#include <span>
#include <vector>

#include "ahm/pointcloud/point_cloud_graph.hpp"
#include "clean_points.hpp"

namespace ahm::pointcloud {

struct Neighborhoods {
  Index k = 0;
  std::vector<Index> indices;        ///< n x k, nearest first, the point itself left out
  std::vector<double> radius;        ///< distance to the k-th neighbour
  std::span<const Index> of(Index i) const { return std::span(indices).subspan(static_cast<std::size_t>(i) * k, k); }
};

struct TangentPlanes {
  std::vector<Vec3> normals;  ///< unit length, signs as given or arbitrary; zero where there is no plane
  Index estimated = 0;        ///< normals that came from PCA
  bool has_plane(Index i) const { return normals[i] != Vec3{0, 0, 0}; }
};

Neighborhoods find_neighborhoods(const CleanPoints& cloud, const NeighborSearch& search, const CloudOptions& options);

/// Normals as given (zero and non-finite ones are estimated) or by principal component analysis of the neighbours. Points whose
/// neighbours lie on a line are tried again with two and four times as many.
TangentPlanes find_tangent_planes(const CleanPoints& cloud, std::span<const Vec3> given, const NeighborSearch& search,
                                  const Neighborhoods& neighborhoods, const CloudOptions& options);

}  // namespace ahm::pointcloud
