/// \file
/// How long edges are somewhere.
///
/// \code
/// const double there = ahm::mean_edge(graph, source.vertices());
/// \endcode
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// Mean length of the edges of vertices, world units; 0 where they have none.
inline double mean_edge(const TangentGraph& graph, std::span<const Vertex> vertices) {
  double sum = 0, count = 0;
  for (const Vertex vertex : vertices) {
    const Star star = graph.star(vertex.index);
    for (std::size_t e = 0; e < star.degree(); ++e) sum += length(star.log(e));
    count += static_cast<double>(star.degree());
  }
  return count > 0 ? sum / count * graph.length_unit() : 0;
}

}  // namespace ahm
