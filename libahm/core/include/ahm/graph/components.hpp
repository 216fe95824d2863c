/// \file
/// Connected components of a tangent graph, and the mean length of edges.
///
/// \code
/// std::cout << ahm::connected_components(graph).count << " components\n";
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Component of each vertex, numbered from 0 in the order of their first vertices. Edges of weight 0 carry no heat and
/// do not connect.
struct Components {
  std::vector<Index> of_vertex;
  Index count = 0;
};

Components connected_components(const TangentGraph& graph);

/// Mean length of the edges of vertices, world units; 0 where they have none.
double mean_edge(const TangentGraph& graph, std::span<const Vertex> vertices);

}  // namespace ahm
