/// \file
/// What an unfolding front finds for a map.
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/maps/wavefront.hpp"
#include "maps/march.hpp"

namespace ahm {

/// Per vertex, world units; empty: distances are measured by heat.
struct Unfolded final : KnownDistances {
  std::vector<double> distances;
  std::vector<double> directions;        ///< 2 per vertex; empty where they are not wanted
  std::vector<double> direction_errors;  ///< of these, radians
  std::vector<Index> nearest;            ///< sample of a curve

  double of(Index vertex) const override { return distances[vertex]; }
};

/// Of a source whose distances are unfolded (`unfolds`), up to a radius; empty of others.
/// @param stars       of a Delaunay triangulation
/// @param directions  whether they are wanted, too; only Delaunay triangulations have them
/// @throws Cancelled
Unfolded unfolded_from(const Source& source, const TangentGraph& graph,
                       const std::shared_ptr<const Wavefront::OneRings>& stars, bool directions, double radius,
                       const std::stop_token& stop);

}  // namespace ahm
