/// \file
/// Clouds with noise and corners, and their maps.
#pragma once

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "backends/surface_maps.hpp"

namespace ahm::test {

using pointcloud::CloudOptions;
using pointcloud::PointCloudSurface;

/// A cloud with its graph factored.
struct SolvedCloud {
  explicit SolvedCloud(const std::vector<Vec3>& points, const std::vector<Vec3>& normals = {})
      : surface(PointCloudSurface::build(points, normals)), solver(surface.graph()) {}

  RowLogMap map(Index row, Variant variant = Variant::adaptive) const {
    return surface.to_rows(solver.solve(surface.source(Row(row)).source, {.variant = variant}));
  }

  PointCloudSurface surface;
  LogMapSolver solver;
};

/// Errors of a map from a row of a sphere, in the axes of the graph made tangent to the exact sphere. Every point must be ok.
inline SphereError sphere_error(const Cloud& sphere, const PointCloudSurface& surface, const RowLogMap& map,
                                Index row) {
  for (std::size_t i = 0; i < sphere.points.size(); ++i) EXPECT_EQ(map.status[i], Status::ok) << "row " << i;
  const Frame frame = *surface.graph().frame(surface.vertex(Row(row)).index);
  const Vec3& normal = sphere.normals[row];
  return sphere_error(sphere.normals, map.u, map.v, row, tangential(frame.x, normal), tangential(frame.y, normal));
}

/// Spacing of n points on the unit sphere.
inline double sphere_spacing(Index n) { return std::sqrt(4 * std::numbers::pi / n); }

/// The points of both clouds; those of the second are moved by `shift`.
inline std::vector<Vec3> joined(std::vector<Vec3> points, const std::vector<Vec3>& others,
                                const Vec3& shift = {0, 0, 0}) {
  for (const Vec3& p : others) points.push_back(p + shift);
  return points;
}

inline std::vector<Vec3> scaled(double factor, std::vector<Vec3> points) {
  for (Vec3& p : points) p = factor * p;
  return points;
}

/// Adds normally distributed offsets along the exact normals.
inline Cloud with_noise(Cloud cloud, double deviation, unsigned seed = 6) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    cloud.points[i] = cloud.points[i] + deviation * normal(random) * cloud.normals[i];
  return cloud;
}

/// Adds normally distributed vectors to the normals, without normalization.
inline Cloud with_noisy_normals(Cloud cloud, double deviation) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, deviation);
  for (Vec3& n : cloud.normals)
    for (double& c : n) c += normal(random);
  return cloud;
}

/// A unit square of rows x rows jittered points, folded back and forth by `bend` radians across y in strips of equal width.
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
