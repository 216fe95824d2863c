#include "clouds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ahm::test {

using std::numbers::pi;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

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

std::array<double, 2> sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q) {
  const double u = dot(x, q), v = dot(y, q), sine = std::hypot(u, v), angle = std::atan2(sine, dot(p, q));
  return sine > 0 ? std::array{angle / sine * u, angle / sine * v} : std::array{0.0, 0.0};
}

SphereError sphere_error(const Cloud& sphere, const pointcloud::PointCloudSurface& graph, const RowLogMap& map,
                         Index p) {
  const Frame frame = *graph.graph().frame(graph.vertex(Row(p)).index);
  // The axes at the source as the solver has them, made tangent to the true sphere.
  const Vec3& normal = sphere.normals[p];
  auto tangent = [&](const Vec3& axis) {
    Vec3 t;
    for (int c = 0; c < 3; ++c) t[c] = axis[c] - dot(axis, normal) * normal[c];
    return t;
  };
  const Vec3 x = tangent(frame.x), y = tangent(frame.y);
  SphereError error{0, 0, 0};
  Index count = 0;
  for (std::size_t i = 0; i < sphere.points.size(); ++i) {
    EXPECT_EQ(map.status[i], Status::ok) << "point " << i;
    const auto exact = sphere_log(normal, x, y, sphere.normals[i]);
    const double distance = std::hypot(exact[0], exact[1]);
    if (distance > 0.9 * pi || static_cast<Index>(i) == p) continue;
    ++count;
    const double off = std::hypot(map.u[i] - exact[0], map.v[i] - exact[1]);
    const double angle =
        std::atan2(map.v[i] * exact[0] - map.u[i] * exact[1], map.u[i] * exact[0] + map.v[i] * exact[1]);
    error.rms += off * off;
    error.angle_rms += angle * angle;
    if (distance < pi / 2) error.hemisphere_max = std::max(error.hemisphere_max, off);
  }
  error.rms = std::sqrt(error.rms / count);
  error.angle_rms = std::sqrt(error.angle_rms / count);
  return error;
}

Solved::Solved(const Cloud& cloud, bool with_normals, pointcloud::CloudOptions options)
    : graph(pointcloud::PointCloudSurface::build(
          cloud.points, with_normals ? std::span<const Vec3>(cloud.normals) : std::span<const Vec3>(), options)),
      solver(graph.graph()) {}

RowLogMap Solved::map(Index point, Variant variant) const {
  return graph.on_rows(solver.solve(graph.source(Row(point)).source, {.variant = variant}));
}

}  // namespace ahm::test
