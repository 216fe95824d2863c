/// \file
/// The result of a wavefront, as a map needs it.
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/maps/wavefront.hpp"
#include "maps/march.hpp"

namespace ahm {

/// Distances and directions of each vertex. All are empty if the distances are computed by heat.
struct Unfolded final : KnownDistances {
  std::vector<double> distances;         ///< world units
  std::vector<double> directions;        ///< 2 per vertex; empty if not requested
  std::vector<double> direction_errors;  ///< expected errors of the directions, radians
  std::vector<Index> nearest;            ///< number of the nearest sample of a curve; empty for points

  double of(Index vertex) const override { return distances[vertex]; }
};

/// Runs a front up to a radius if the distances of the source are unfolded (`unfolds`); otherwise returns an empty result.
/// @param stars       one-rings of the graph; may be null
/// @param directions  whether to compute directions, too; only on Delaunay triangulations
/// @throws Cancelled
Unfolded unfolded_from(const Source& source, const TangentGraph& graph,
                       const std::shared_ptr<const Wavefront::OneRings>& stars, bool directions, double radius,
                       const std::stop_token& stop);

}  // namespace ahm
