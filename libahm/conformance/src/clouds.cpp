#include "ahm/conformance/clouds.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "ahm/conformance/vectors.hpp"

namespace ahm::test {

using std::numbers::pi;

Cloud flat_cloud(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  // Orthonormal axes of a plane in general position.
  const Vec3 x{2.0 / 3, -1.0 / 3, 2.0 / 3}, y{2.0 / 3, 2.0 / 3, -1.0 / 3}, normal{-1.0 / 3, 2.0 / 3, 2.0 / 3};
  Cloud cloud;
  while (static_cast<Index>(cloud.points.size()) < n) {
    const double u = std::pow(uniform(random), 1.5), v = uniform(random);
    if (std::hypot(u - 0.5, v - 0.5) < 0.15) continue;
    cloud.plane.push_back({u, v});
    cloud.points.push_back({u * x[0] + v * y[0] + 3, u * x[1] + v * y[1], u * x[2] + v * y[2] - 1});
    cloud.normals.push_back(normal);
  }
  return cloud;
}

Cloud even_sphere(Index n) {
  Cloud cloud;
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = std::sqrt(1.0 - z * z), turn = i * pi * (3.0 - std::sqrt(5.0));
    cloud.points.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  cloud.normals = cloud.points;
  return cloud;
}

Cloud random_sphere(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Cloud cloud;
  for (Index i = 0; i < n; ++i) {
    Vec3 p{normal(random), normal(random), normal(random)};
    const double r = std::sqrt(dot(p, p));
    for (double& c : p) c /= r;
    cloud.points.push_back(p);
  }
  cloud.normals = cloud.points;
  return cloud;
}

Cloud rolled_cloud(Index rows, double radius) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  Cloud cloud;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < rows; ++j) {
      const double u = (i + jitter(random)) / (rows - 1), v = (j + jitter(random)) / (rows - 1), angle = v / radius;
      cloud.plane.push_back({u, v});
      cloud.points.push_back({u, radius * std::sin(angle), radius * std::cos(angle)});
      cloud.normals.push_back({0, std::sin(angle), std::cos(angle)});
    }
  return cloud;
}

Cloud moebius_cloud(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Cloud cloud;
  for (Index i = 0; i < n; ++i) {
    const double turn = 2 * pi * uniform(random), across = 0.4 * (2 * uniform(random) - 1);
    const double r = 1 + across * std::cos(turn / 2);
    cloud.points.push_back({r * std::cos(turn), r * std::sin(turn), across * std::sin(turn / 2)});
  }
  return cloud;
}

}  // namespace ahm::test
