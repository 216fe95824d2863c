#include "flat_center.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <numeric>

#include "ahm/util/small_math.hpp"

namespace ahm {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

Eigen::Map<const VectorXd> point(const FlatPoints& points, std::size_t k) {
  return {points[k].data(), static_cast<Eigen::Index>(points.dimension)};
}

double sum_of_distances(const FlatPoints& points, const VectorXd& x) {
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) sum += points.weights[k] * (point(points, k) - x).norm();
  return sum;
}

/// F(x) = sum w |z - x| near x. Points at x itself count by their weight alone.
struct Slope {
  VectorXd pull;      ///< sum w u, u the unit vectors towards the points: - grad F
  MatrixXd hessian;   ///< sum w / |z - x| (id - u u^T)
  double rate = 0;    ///< sum w / |z - x|, not less than any eigenvalue of the Hessian
  double weight = 0;  ///< of the points at x

  /// Vardi & Zhang 2000: the points at x hold it where the others do not pull harder.
  bool is_least() const { return pull.norm() <= weight; }
};

Slope slope_at(const FlatPoints& points, const VectorXd& x) {
  const Eigen::Index d = x.size();
  Slope slope{VectorXd::Zero(d), MatrixXd::Zero(d, d)};
  VectorXd u(d);
  for (std::size_t k = 0; k < points.size(); ++k) {
    u = point(points, k) - x;
    const double r = u.norm(), w = points.weights[k];
    if (r == 0) {
      slope.weight += w;
      continue;
    }
    u /= r;
    slope.pull += w * u;
    slope.rate += w / r;
    slope.hessian.diagonal().array() += w / r;
    slope.hessian.noalias() -= w / r * u * u.transpose();
  }
  return slope;
}

/// The better of Newton's step and Weiszfeld's, which never fails to go down, at points too [VZ00]. Newton's may be worse by rounding.
VectorXd step(const FlatPoints& points, const VectorXd& x, const Slope& slope) {
  VectorXd weiszfeld = (1 - slope.weight / slope.pull.norm()) / slope.rate * slope.pull;
  if (slope.weight > 0) return weiszfeld;
  const VectorXd newton = slope.hessian.ldlt().solve(slope.pull);
  if (!newton.allFinite()) return weiszfeld;
  const double by_newton = sum_of_distances(points, x + newton), by_weiszfeld = sum_of_distances(points, x + weiszfeld);
  return by_newton <= by_weiszfeld * (1 + 1e-13) ? newton : weiszfeld;
}

VectorXd nearest_point(const FlatPoints& points, const VectorXd& x) {
  const std::vector<double> away = distances(points, {x.data(), static_cast<std::size_t>(x.size())});
  return point(points, static_cast<std::size_t>(std::min_element(away.begin(), away.end()) - away.begin()));
}

}  // namespace

std::vector<double> distances(const FlatPoints& points, std::span<const double> x) {
  const Eigen::Map<const VectorXd> at(x.data(), static_cast<Eigen::Index>(x.size()));
  std::vector<double> away(points.size());
  for (std::size_t k = 0; k < away.size(); ++k) away[k] = (point(points, k) - at).norm();
  return away;
}

std::vector<double> flat_mean(const FlatPoints& points) {
  const double total = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  std::vector<double> mean(points.dimension, 0.0);
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t a = 0; a < mean.size(); ++a) mean[a] += points.weights[k] / total * points[k][a];
  return mean;
}

std::vector<double> flat_median(const FlatPoints& points) {
  const std::vector<double> mean = flat_mean(points);
  VectorXd x = Eigen::Map<const VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()));
  const std::vector<double> away = distances(points, mean);
  const double size = *std::max_element(away.begin(), away.end());
  for (int pass = 0; pass < 1000; ++pass) {
    // A median that is one of the points would be approached ever more slowly.
    const VectorXd z = nearest_point(points, x);
    if (slope_at(points, z).is_least()) {
      x = z;
      break;
    }
    const Slope slope = slope_at(points, x);
    if (slope.is_least()) break;
    const VectorXd by = step(points, x, slope);
    x += by;
    if (by.norm() <= 2 * std::numeric_limits<double>::epsilon() * size) break;
  }
  return {x.data(), x.data() + x.size()};
}

}  // namespace ahm
