#include "paraboloid.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace ahm {

void Paraboloid::add(const Vec2& x, double z, double weight) {
  const double u = x[0] / unit_, v = x[1] / unit_;
  const std::array<double, 5> row{u, v, -u * u / 2, -u * v, -v * v / 2};
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t b = 0; b < 5; ++b) normal_[5 * a + b] += weight * row[a] * row[b];
    right_[a] += weight * row[a] * (z / unit_);
  }
}

PrincipalCurvature Paraboloid::curvature() const {
  Eigen::FullPivLU<Eigen::Matrix<double, 5, 5>> lu(Eigen::Map<const Eigen::Matrix<double, 5, 5>>(normal_.data()));
  lu.setThreshold(1e-10);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!lu.isInvertible()) return {{unknown, unknown}, {unknown, unknown}};
  const Eigen::Matrix<double, 5, 1> fit = lu.solve(Eigen::Map<const Eigen::Matrix<double, 5, 1>>(right_.data()));
  const double mean = (fit[2] + fit[4]) / 2, half = (fit[2] - fit[4]) / 2, gap = std::hypot(half, fit[3]);
  // S turns like a vector of twice the angle: the eigenvector of mean + gap lies at half the angle of (half, S_01).
  const double sign = mean < 0 ? -1 : 1, angle = std::atan2(sign * fit[3], sign * half) / 2;
  return {{(mean + sign * gap) / unit_, (mean - sign * gap) / unit_}, {std::cos(angle), std::sin(angle)}};
}

}  // namespace ahm
