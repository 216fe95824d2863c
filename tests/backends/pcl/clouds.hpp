/// \file
/// Generated clouds for the tests of ahm::pcl.
#pragma once

#include <random>
#include <vector>

#include "ahm/util/vec.hpp"

namespace ahm::test {

/// n points uniform in a box around `center`.
inline std::vector<Vec3> random_box(std::size_t n, const Vec3& center = {0, 0, 0}, double size = 1.0,
                                    unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.5 * size, 0.5 * size);
  std::vector<Vec3> points(n);
  for (Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) p[a] = center[a] + uniform(generator);
  return points;
}

/// m x m points on the square [0, 1]^2 at height 0.
inline std::vector<Vec3> flat_square(int m) {
  std::vector<Vec3> points;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) points.push_back({i / (m - 1.0), j / (m - 1.0), 0.0});
  return points;
}

inline double squared_distance(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

}  // namespace ahm::test
