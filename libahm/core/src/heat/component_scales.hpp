/// \file
/// The length scale of each connected component: heat does not cross between components, so each one diffuses for a time
/// of its own, and its numbers do not depend on what else is in the graph.
#pragma once

#include <vector>

#include "ahm/graph/components.hpp"
#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Per component: h_c, its mean edge length in graph units, and its number of vertices.
///
/// The graph tells h_c (`component_edge_length`); else that of a graph of one component is `mean_edge_length`, which is shared out
/// to several in the ratio of their mean |e_ij|.
struct ComponentScales {
  explicit ComponentScales(const TangentGraph& graph);

  Components components;
  std::vector<double> edge_length;
  std::vector<Index> sizes;

  Index component(Index vertex) const { return components.of_vertex[vertex]; }
  double h(Index vertex) const { return edge_length[components.of_vertex[vertex]]; }
};

/// tau = t_coef h_c^2 of every vertex, in squared graph units.
/// @throws InvalidArgument (t_coef; a tau out of range)
std::vector<double> diffusion_times(const ComponentScales& scales, double t_coef);

/// t_coef h^2, checked. @throws InvalidArgument
double diffusion_time(double t_coef, double h);

}  // namespace ahm
