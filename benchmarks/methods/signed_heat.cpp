// SHM: transports the normals of the source, normalizes them, and integrates.
#include "methods/signed_heat.hpp"

#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "methods/heat_fields.hpp"

namespace ahm::methods {
namespace {

void check_curve(const Source& curve, const TangentGraph& graph) {
  if (graph.dimension() != 2 || curve.dimension() != 2 || curve.vertices().empty())
    throw InvalidArgument("'curve' must have samples with axes on a graph of dimension 2; use stroke_source");
  for (const auto [i] : curve.vertices())
    if (i < 0 || i >= graph.size())
      throw InvalidArgument("'curve': vertex " + std::to_string(i) + " must be in [0, " + std::to_string(graph.size()) +
                            ")");
}

/// Whether heat has reached a vertex of the field.
bool has_heat(std::span<const double> unit_field, std::size_t vertex, std::size_t d) {
  const auto vector = unit_field.subspan(vertex * d, d);
  return std::any_of(vector.begin(), vector.end(), [](double x) { return x != 0; });
}

}  // namespace

SignedHeat::SignedHeat(const TangentGraph& graph, double t_coef)
    : graph_(graph), heat_(graph, {.t_coef = t_coef}), integration_(graph) {}

Result SignedHeat::solve(Index source) const {
  check_source(source, graph_.size());
  const auto d = static_cast<std::size_t>(graph_.dimension());
  // I. The normals of a point are those of a small circle around it.
  std::vector<double> X(static_cast<std::size_t>(graph_.size()) * d, 0.0);
  add_outward_circle(graph_, source, X);
  heat_.solve_vector(X, 1);
  // II. Normalize.
  normalize(X, graph_.dimension());
  // III. Integrate.
  return {{}, distances_from(integration_.integrate(X, source), source, graph_.length_unit(), [&](std::size_t i) {
            return static_cast<Index>(i) == source || has_heat(X, i, d);
          })};
}

std::vector<double> SignedHeat::signed_distance(const Source& curve) const {
  check_curve(curve, graph_);
  // I. Normals, weighted by their share of the curve's length.
  std::vector<double> X(static_cast<std::size_t>(graph_.size()) * 2, 0.0);
  const double most = *std::max_element(curve.weights().begin(), curve.weights().end());
  if (!(most > 0)) throw InvalidArgument("'curve': every weight is 0; at least one sample needs a positive weight");
  for (std::size_t k = 0; k < curve.vertices().size(); ++k)
    for (std::size_t a : {0, 1})
      X[static_cast<std::size_t>(curve.vertices()[k].index) * 2 + a] +=
          source_heat * (curve.weights()[k] / most) * curve.axes()[4 * k + 2 * a + 1];
  heat_.solve_vector(X, 1);
  // II. Normalize.
  normalize(X, 2);
  // III. Integrate; zero on average over the curve.
  std::vector<double> f = integration_.integrate(X);
  double mean = 0, weights = 0;
  for (std::size_t k = 0; k < curve.vertices().size(); ++k) {
    mean += curve.weights()[k] / most * f[curve.vertices()[k].index];
    weights += curve.weights()[k] / most;
  }
  mean /= weights;
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = has_heat(X, i, 2) ? (f[i] - mean) * graph_.length_unit() : nan;
  return f;
}

}  // namespace ahm::methods
