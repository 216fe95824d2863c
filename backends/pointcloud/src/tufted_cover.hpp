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
/// loops dropped. Fills `flips` and `mollification` (in units of the clean points, the largest of the parts) of the report.
WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, const CloudParts& parts, unsigned threads,
                               CloudDetails& report);

/// How far the least mollification of a triangle with these side lengths is from none, given the mean length of all sides of
/// its part of the cloud: the largest of these over all triangles there, if positive, is added to every edge.
double mollification_of(double a, double b, double c, double mean_length);

/// The same Laplacian of a part of a cloud, whose border is made of points that lack triangles.
struct CoverPart {
  double mollification = 0;    ///< of the whole cloud
  std::vector<char> complete;  ///< of each point: all triangles at it are there
  /// Filled: of each point, that no flip which the border had a part in came near it; its edges and mass are those of the
  /// whole cloud.
  std::vector<char> certain;
};
WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, CoverPart& part, CloudDetails& report);

}  // namespace ahm::pointcloud
