/// \file
/// Clouds with corners and noise whose distances are known.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "ahm/conformance/clouds.hpp"

namespace ahm::test {

/// Adds normally distributed offsets along the exact normals.
inline Cloud with_noise(Cloud cloud, double deviation, unsigned seed = 6) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const double offset = normal(random);
    for (int k = 0; k < 3; ++k) cloud.points[i][k] += offset * cloud.normals[i][k];
  }
  return cloud;
}

/// Adds normally distributed vectors to the normals; their lengths are no longer one.
inline Cloud with_noisy_normals(Cloud cloud, double deviation, unsigned seed = 9) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  for (Vec3& n : cloud.normals)
    for (double& c : n) c += normal(random);
  return cloud;
}

/// A unit square of rows x rows jittered points, folded to and fro across y by `bend` radians in strips of equal width.
/// `plane` is the position before folding.
inline Cloud folded_cloud(Index rows, int strips, double bend, unsigned seed = 4) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.5, 0.5);
  const double width = 1.0 / strips, c = std::cos(bend / 2), s = std::sin(bend / 2);
  Cloud cloud;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < rows; ++j) {
      const double u = (i + 0.5 + jitter(random)) / rows, v = (j + 0.5 + jitter(random)) / rows;
      const int strip = std::min(strips - 1, static_cast<int>(v / width));
      const double along = v - strip * width, side = strip % 2 ? 1.0 : -1.0;
      cloud.plane.push_back({u, v});
      cloud.points.push_back({u, v * c, (strip % 2 ? width - along : along) * s});
      cloud.normals.push_back({0, side * s, c});
    }
  return cloud;
}

}  // namespace ahm::test
