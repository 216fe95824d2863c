/// \file
/// The tufted Laplacian [SC20]: edge weights >= 0 and lumped masses from any set of triangles.
#pragma once

#include <vector>

#include "local_delaunay.hpp"

namespace ahm::pointcloud {

/// Undirected edges {tail < head} in lexicographic order, and a mass per vertex (0 where no triangle touches it).
struct WeightedEdges {
  std::vector<Index> tails, heads;
  std::vector<double> weights;  ///< > 0
  std::vector<double> masses;
};

/// Glues two copies of every triangle into a manifold without boundary, mollifies its edge lengths, flips it to an
/// intrinsic Delaunay triangulation and sums its cotangent weights over the two layers. Parallel edges are summed,
/// loops dropped. Fills `flips` and `mollification` (in units of the clean points) of the report.
WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, CloudDetails& report);

}  // namespace ahm::pointcloud
