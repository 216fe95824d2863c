// SEM: the direction is that in which the heat of a vertex arrives at the source, the distance that of the heat method.
#include <cmath>

#include "methods/method.hpp"
#include "methods/star_heat.hpp"

namespace ahm::methods {
namespace {

class SmoothedExponential final : public Baseline {
 public:
  SmoothedExponential(const TangentGraph& graph, double t_coef)
      : graph_(graph), heat_(graph, {.t_coef = t_coef}), distance_(graph) {}

  std::string_view name() const noexcept override { return "SEM"; }
  Result solve(Index source) const override;

 private:
  /// Gradient at the source of the heat kernel k(., i) of every vertex i, column major n x d.
  std::vector<double> arrival(Index source) const;

  const TangentGraph& graph_;
  HeatOperators heat_;
  StarHeat distance_;
};

std::vector<double> SmoothedExponential::arrival(Index source) const {
  const auto n = static_cast<std::size_t>(graph_.size());
  const Star star = graph_.star(source);
  const Eigen::MatrixXd coefficients = StarGradient(star.dimension).coefficients(star);
  // k(j, i) = k(i, j) and the gradient is linear, so the sources at the star's vertices are summed before one diffusion:
  // sum_j c_j (k(j, i) - k(p, i)).
  std::vector<double> X(n * static_cast<std::size_t>(star.dimension), 0.0);
  for (int a = 0; a < star.dimension; ++a)
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const double c = source_heat * graph_.mean_edge_length() * coefficients(a, static_cast<Eigen::Index>(e));
      X[static_cast<std::size_t>(a) * n + static_cast<std::size_t>(star.neighbors[e])] += c;
      X[static_cast<std::size_t>(a) * n + static_cast<std::size_t>(source)] -= c;
    }
  heat_.solve_scalar(X, star.dimension);
  return X;
}

Result SmoothedExponential::solve(Index source) const {
  check_source(source, graph_.size());
  const auto n = static_cast<std::size_t>(graph_.size()), d = static_cast<std::size_t>(graph_.dimension());
  const std::vector<double> toward = arrival(source);
  Result result{std::vector<double>(n * d, nan), distance_.from_heat(scalar_heat(heat_, source), source)};
  for (std::size_t i = 0; i < n; ++i) {
    double length = 0;
    for (std::size_t a = 0; a < d; ++a) length = std::hypot(length, toward[a * n + i]);
    for (std::size_t a = 0; a < d; ++a)
      result.coordinates[i * d + a] = result.distance[i] * (toward[a * n + i] / length);
  }
  std::fill_n(&result.coordinates[static_cast<std::size_t>(source) * d], d, 0.0);
  return result;
}

}  // namespace

Method smoothed_exponential(const TangentGraph& graph, double t_coef) {
  return std::make_unique<SmoothedExponential>(graph, t_coef);
}

}  // namespace ahm::methods
