/// \file
/// The length scale of each connected component. Heat does not cross between components, so each one has its own diffusion time, and
/// its results do not depend on the others.
#pragma once

#include <vector>

#include "ahm/graph/components.hpp"
#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Mean edge length h_c (graph units) and number of vertices of each component.
///
/// h_c is the graph's `component_edge_length` if it has one. Otherwise it is `mean_edge_length`, scaled for several components in the
/// ratio of their mean |e_ij|.
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

/// Computes t_coef h^2. @throws InvalidArgument (t_coef; a tau out of range)
double diffusion_time(double t_coef, double h);

}  // namespace ahm
