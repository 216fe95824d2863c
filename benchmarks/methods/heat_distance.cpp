// HM on a graph.
#include <cmath>

#include "methods/edge_integration.hpp"
#include "methods/method.hpp"
#include "methods/star_heat.hpp"

namespace ahm::methods {
namespace {

class GraphHeatDistance final : public Baseline {
 public:
  GraphHeatDistance(const TangentGraph& graph, double t_coef) : heat_(graph, {.t_coef = t_coef}), distance_(graph) {}

  std::string_view name() const noexcept override { return "HM (graph)"; }
  Result solve(Index source) const override {
    check_source(source, heat_.size());
    return {{}, distance_.from_heat(scalar_heat(heat_, source), source)};
  }

 private:
  HeatOperators heat_;
  StarHeat distance_;
};

}  // namespace

StarHeat::StarHeat(const TangentGraph& graph) : graph_(graph), integration_(graph) {}

std::vector<double> StarHeat::from_heat(std::vector<double> lambda, Index source) const {
  const auto d = static_cast<std::size_t>(graph_.dimension());
  for (double& u : lambda) u = u >= least_heat ? std::log(u) : nan;

  // X = -grad u / |grad u| = -grad log u / |grad log u|.
  std::vector<double> field(lambda.size() * d, 0.0), increments;
  StarGradient gradient(graph_.dimension());
  for (Index i = 0; i < graph_.size(); ++i) {
    const double here = lambda[i];
    if (std::isnan(here)) continue;
    const Star star = graph_.star(i);
    increments.clear();
    for (Index j : star.neighbors) increments.push_back(here - lambda[j]);
    const Eigen::VectorXd& g = gradient.fit(star, increments);
    if (const double length = g.norm(); length > 0)
      for (std::size_t a = 0; a < d; ++a)
        field[static_cast<std::size_t>(i) * d + a] = g[static_cast<Eigen::Index>(a)] / length;
  }

  // Laplacian phi = div X.
  return distances_from(integration_.integrate(field, source), source, graph_.length_unit(),
                        [&](std::size_t i) { return !std::isnan(lambda[i]); });
}

Method heat_distance(const TangentGraph& graph, double t_coef) {
  return std::make_unique<GraphHeatDistance>(graph, t_coef);
}

}  // namespace ahm::methods
