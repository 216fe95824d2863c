/// \file
/// Connected components of a tangent graph.
///
/// \code
/// std::cout << ahm::connected_components(graph).count << " components\n";
/// \endcode
#pragma once

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

}  // namespace ahm
