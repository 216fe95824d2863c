/// \file
/// Connected components and mean edge lengths of a tangent graph.
///
/// \code
/// std::cout << ahm::connected_components(graph).count << " components\n";
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Component of each vertex, numbered from 0 in the order of their first vertices. Edges of weight 0 carry no heat, so they do not
/// connect vertices.
struct Components {
  std::vector<Index> of_vertex;
  Index count = 0;
};

Components connected_components(const TangentGraph& graph);

/// Mean length of the edges at some vertices, world units; 0 if they have no edges.
double mean_edge(const TangentGraph& graph, std::span<const Vertex> vertices);

}  // namespace ahm
