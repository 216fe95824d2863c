#include "methods/heat_fields.hpp"

#include <cmath>
#include <string>

#include "ahm/error.hpp"

namespace ahm::methods {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;
using Transport = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace

void check_source(Index source, Index size) {
  if (source < 0 || source >= size)
    throw InvalidArgument("'source' " + std::to_string(source) + " must be in [0, " + std::to_string(size) + ")");
}

void carry_here(const TangentGraph& graph, const Star& star, std::size_t edge, const double* there, double* here) {
  const auto d = static_cast<std::size_t>(star.dimension);
  if (graph.transport_kind() == TransportKind::rotation2) {
    const double c = star.transports[2 * edge], s = star.transports[2 * edge + 1];
    here[0] = c * there[0] - s * there[1];
    here[1] = s * there[0] + c * there[1];
    return;
  }
  Eigen::Map<Eigen::VectorXd>(here, star.dimension).noalias() =
      Transport(star.transports.data() + edge * d * d, star.dimension, star.dimension) *
      ConstVector(there, star.dimension);
}

void carry_there(const TangentGraph& graph, const Star& star, std::size_t edge, const double* here, double* there) {
  const auto d = static_cast<std::size_t>(star.dimension);
  if (graph.transport_kind() == TransportKind::rotation2) {
    const double c = star.transports[2 * edge], s = star.transports[2 * edge + 1];
    there[0] = c * here[0] + s * here[1];
    there[1] = c * here[1] - s * here[0];
    return;
  }
  Eigen::Map<Eigen::VectorXd>(there, star.dimension).noalias() =
      Transport(star.transports.data() + edge * d * d, star.dimension, star.dimension).transpose() *
      ConstVector(here, star.dimension);
}

double log_length(const Star& star, std::size_t edge) {
  return ConstVector(star.log(edge).data(), star.dimension).norm();
}

std::vector<double> scalar_heat(const HeatOperators& heat, Index source) {
  std::vector<double> lambda(static_cast<std::size_t>(heat.size()), 0.0);
  lambda[source] = source_heat;
  heat.solve_scalar(lambda, 1);
  return lambda;
}

void add_outward_circle(const TangentGraph& graph, Index source, std::span<double> field) {
  const Star star = graph.star(source);
  const auto d = static_cast<std::size_t>(star.dimension);
  std::vector<double> outward(d);
  for (std::size_t e = 0; e < star.degree(); ++e) {
    // The direction times the measure: e_pj / |e_pj| * w_pj |e_pj|.
    carry_there(graph, star, e, star.log(e).data(), outward.data());
    double* there = &field[static_cast<std::size_t>(star.neighbors[e]) * d];
    for (std::size_t a = 0; a < d; ++a)
      there[a] += source_heat / graph.mean_edge_length() * star.weights[e] * outward[a];
  }
}

void normalize(std::span<double> field, int dimension) {
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t begin = 0; begin < field.size(); begin += d) {
    Eigen::Map<Eigen::VectorXd> vector(&field[begin], dimension);
    const double length = vector.stableNorm();
    length >= least_heat ? vector /= length : vector.setZero();
  }
}

StarGradient::StarGradient(int dimension)
    : normal_(dimension, dimension), slopes_(dimension), gradient_(dimension), factors_(dimension) {}

template <class Use>
void StarGradient::factor(const Star& star, const Use& use) {
  normal_.setZero();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const ConstVector log(star.log(e).data(), star.dimension);
    if (const double square = log.squaredNorm(); use(e) && square > 0)
      normal_.noalias() += log * log.transpose() / square;
  }
  // Directions without an edge get zero slope.
  normal_.diagonal().array() += 1e-13 * normal_.trace() + std::numeric_limits<double>::min();
  factors_.compute(normal_);
}

const Eigen::VectorXd& StarGradient::fit(const Star& star, std::span<const double> increments) {
  factor(star, [&](std::size_t e) { return std::isfinite(increments[e]); });
  slopes_.setZero();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const ConstVector log(star.log(e).data(), star.dimension);
    if (const double square = log.squaredNorm(); std::isfinite(increments[e]) && square > 0)
      slopes_ += log * (increments[e] / square);
  }
  gradient_ = factors_.solve(slopes_);
  return gradient_;
}

Eigen::MatrixXd StarGradient::coefficients(const Star& star) {
  factor(star, [](std::size_t) { return true; });
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(star.dimension, static_cast<Eigen::Index>(star.degree()));
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const ConstVector log(star.log(e).data(), star.dimension);
    if (const double square = log.squaredNorm(); square > 0)
      columns.col(static_cast<Eigen::Index>(e)) = factors_.solve(log / square);
  }
  return columns;
}

}  // namespace ahm::methods
