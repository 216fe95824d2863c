/// \file
/// Generated clouds for the benchmarks.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::bench {

/// Points of the unit sphere at random.
inline std::vector<Vec3> random_sphere(Index n) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (Index i = 0; i < n; ++i) {
    Vec3 p{normal(random), normal(random), normal(random)};
    const double r = std::hypot(p[0], p[1], p[2]);
    points.push_back({p[0] / r, p[1] / r, p[2] / r});
  }
  return points;
}

/// Points of the unit sphere on a golden spiral: evenly spread.
inline std::vector<Vec3> even_sphere(Index n) {
  std::vector<Vec3> points;
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = std::sqrt(1.0 - z * z), turn = i * 2.39996322972865332;
    points.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  return points;
}

}  // namespace ahm::bench
