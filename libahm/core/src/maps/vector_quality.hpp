/// \file
/// The quality of one vector of a map: from its error, and from the edges that the map stretches because they cross the cut locus.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "ahm/graph/components.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// Half of the largest excess of an edge's length in a map over its length, over the neighbors of a vertex in the map; world
/// units. Rounding is ignored.
/// @param length_in_map  length_in_map(j): distance of vertex j from this vertex in the map, world units; NaN if the map does not contain j
template <class Length>
double jump_at(const TangentGraph& graph, Index vertex, const Length& length_in_map) {
  constexpr double rounding = 1e-9;
  double jump = 0;
  const Star star = graph.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const double apart = length_in_map(star.neighbors[e]);
    const double excess = (apart - graph.length_unit() * length(star.log(e))) / 2;
    if (excess > rounding * apart) jump = std::max(jump, excess);
  }
  return jump;
}

/// The quality of `map_quality` at a vertex. All lengths are in world units.
/// @param distance  of the vertex from the source. Below an edge of the vertex, and below h, it counts as the shorter of both
/// @param h         mean edge length
inline double quality_of(const TangentGraph& graph, Vertex vertex, double error, double spread, double distance,
                         double h) {
  constexpr double doubtful_error = 0.1;  // relative error at which the quality is 0.5
  const double edge = std::min(h, mean_edge(graph, std::span(&vertex, 1)));
  const double doubt = std::hypot(error, spread / 3) / std::max(distance, edge) / doubtful_error;
  return 1 / (1 + doubt * doubt);
}

}  // namespace ahm
