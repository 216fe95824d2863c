#include "heat/component_scales.hpp"

#include <cmath>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

/// Mean |e_ij| of each component and of the whole graph; 0 if there are no edges.
struct MeanLengths {
  std::vector<double> of_component;
  double of_all = 0;
};

MeanLengths mean_lengths(const TangentGraph& graph, const Components& components) {
  const auto count = static_cast<std::size_t>(components.count);
  MeanLengths sum{std::vector<double>(count, 0.0), 0};
  std::vector<Offset> edges(count, 0);
  Offset all = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    const Index c = components.of_vertex[i];
    for (std::size_t e = 0; e < star.degree(); ++e) sum.of_component[c] += length(star.log(e));
    edges[c] += static_cast<Offset>(star.degree());
  }
  for (std::size_t c = 0; c < count; ++c) {
    sum.of_all += sum.of_component[c];
    all += edges[c];
    if (edges[c] > 0) sum.of_component[c] /= static_cast<double>(edges[c]);
  }
  if (all > 0) sum.of_all /= static_cast<double>(all);
  return sum;
}

}  // namespace

ComponentScales::ComponentScales(const TangentGraph& graph)
    : components(connected_components(graph)),
      edge_length(static_cast<std::size_t>(components.count), graph.mean_edge_length()),
      sizes(edge_length.size(), 0) {
  for (Index c : components.of_vertex) ++sizes[c];
  if (graph.size() > 0 && graph.component_edge_length(0) > 0) {
    for (Index i = 0; i < graph.size(); ++i)
      if (const double h = graph.component_edge_length(i); h > 0) edge_length[components.of_vertex[i]] = h;
    return;
  }
  if (components.count < 2) return;
  const MeanLengths mean = mean_lengths(graph, components);
  for (std::size_t c = 0; c < edge_length.size(); ++c)
    if (mean.of_component[c] > 0) edge_length[c] *= mean.of_component[c] / mean.of_all;
}

double diffusion_time(double t_coef, double h) {
  const double tau = t_coef * h * h;
  if (!(t_coef > 0) || !std::isfinite(t_coef))
    throw InvalidArgument("t_coef is " + detail::number(t_coef) + "; it must be finite and > 0 (default 1)");
  if (!(tau >= 1e-290) || !(tau <= 1e290))
    throw InvalidArgument("diffusion_time_range",
                          "t_coef is " + detail::number(t_coef) +
                              ": t_coef times the squared mean edge length is outside the range of double precision",
                          "use a t_coef near 1, and set the graph's length_unit near its edge length");
  return tau;
}

std::vector<double> diffusion_times(const ComponentScales& scales, double t_coef) {
  std::vector<double> of_component, tau(scales.components.of_vertex.size());
  for (double h : scales.edge_length) of_component.push_back(diffusion_time(t_coef, h));
  for (std::size_t i = 0; i < tau.size(); ++i) tau[i] = of_component[scales.components.of_vertex[i]];
  return tau;
}

}  // namespace ahm
