/// \file
/// The tufted Laplacian [SC20]: edge weights >= 0 and lumped masses from any set of triangles.
#pragma once

#include <vector>

#include "local_delaunay.hpp"

namespace ahm::pointcloud {

/// Undirected edges {tail < head} in lexicographic order, and a mass per vertex (0 if no triangle touches it).
struct WeightedEdges {
  std::vector<Index> tails, heads;
  std::vector<double> weights;  ///< > 0
  std::vector<double> masses;
};

/// Glues two copies of every triangle into a manifold without boundary, mollifies its edge lengths, flips it to an intrinsic
/// Delaunay triangulation, and sums its cotangent weights over the two copies. Sums parallel edges and drops loops. Fills
/// `flips` and `mollification` (in units of the clean points, the largest of the parts) of the report.
/// Its result contains the weights w of the connection Laplacian of clouds; `tangent_edges` adds the transports.
WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, const CloudParts& parts, unsigned threads,
                               CloudDetails& report);

/// The length that must be added to every edge for this triangle to keep its margin in the triangle inequality; negative if the
/// margin is larger. The largest value over all triangles of a part, if positive, is added to every edge of that part.
/// @param a, b, c      side lengths of the triangle
/// @param mean_length  mean length of all sides in its part of the cloud
double mollification_of(double a, double b, double c, double mean_length);

/// Input and output of the Laplacian for a part of a cloud. Points at the border of the part lack triangles.
struct CoverPart {
  double mollification = 0;    ///< length added to every edge, that of the whole cloud
  std::vector<char> complete;  ///< for each point, whether all its triangles are present
  /// Output, for each point: no flip that the border influenced came near it. Its edges and mass equal those of the whole cloud.
  std::vector<char> certain;
};
/// The Laplacian for a part of a cloud.
WeightedEdges tufted_laplacian(const CleanPoints& cloud, const TangentPlanes& planes,
                               const std::vector<Triangle>& triangles, CoverPart& part, CloudDetails& report);

}  // namespace ahm::pointcloud
