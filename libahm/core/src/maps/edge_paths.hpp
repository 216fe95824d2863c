/// \file
/// Shortest ways along the edges of a graph that need not fit into memory.
#pragma once

#include <functional>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/progress.hpp"

namespace ahm {

/// Dijkstra's algorithm from the points of a source over all edges, also those without weight: calls settle(vertex, length)
/// in order of length, once for each vertex that is no farther than `longest`. What is known of a vertex is forgotten when all
/// its neighbours are settled, so that memory grows with the front.
/// @param longest  world units, as the lengths told
/// @throws Cancelled, and what graph and `settle` throw
void edge_paths(const TangentGraph& graph, const Source& source, double longest, const Progress& progress,
                const std::function<void(Index vertex, double length)>& settle);

}  // namespace ahm
