// Distances of order 2 on clouds, from each source alone, against exact ones over the faces whose corners the points are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

/// A sphere of 2,562 points, each moved by `place`.
template <class Place>
Mesh sphere_like(Place&& place) {
  Mesh mesh = split_icosphere(2562);
  for (Vec3& p : mesh.positions) p = place(p);
  return mesh;
}

Vec3 peanut(const Vec3& p) {
  const double waist = 0.25 + p[0] * p[0];
  return {1.5 * p[0], waist * p[1], waist * p[2]};
}

Vec3 star(const Vec3& p) {
  const double reach = 1 + 0.35 * std::cos(4 * std::atan2(p[1], p[0])) * (1 - p[2] * p[2]);
  return {reach * p[0], reach * p[1], 0.5 * p[2]};
}

/// Relative errors.
struct Error {
  double mean, most;  ///< the second: the 95th percentile
};

/// Beyond three edges from the source.
Error error(const RowLogMap& found, const RowLogMap& exact, double near) {
  std::vector<double> errors;
  double sum = 0;
  for (std::size_t i = 0; i < found.distance.size(); ++i) {
    if (!(exact.distance[i] > near)) continue;
    errors.push_back(std::abs(found.distance[i] - exact.distance[i]) / exact.distance[i]);
    sum += errors.back();
  }
  std::sort(errors.begin(), errors.end());
  return {sum / static_cast<double>(errors.size()), errors[errors.size() * 95 / 100]};
}

/// Of order 2 over order 1: the largest ratio of any source, and that of the sums of all.
struct Gain {
  double worst = 0, mean = 0;
};

Gain gain(const Mesh& mesh, Variant variant) {
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
  const ExactGeodesics geodesics(surface);
  const LogMapSolver first(cloud.graph(), {.variant = variant}),
      second(cloud.graph(), {.variant = variant, .order = 2});
  const double near = 3 * surface.graph().mean_edge_length() * surface.graph().length_unit();
  Gain gain;
  double sum = 0, sum_of_first = 0;
  for (Index k = 0; k < 8; ++k) {
    const Row source(mesh.vertices() / 11 + k * (mesh.vertices() / 9));
    const RowLogMap exact = surface.on_rows(geodesics.log_map(source));
    const auto error_of = [&](const LogMapSolver& solver) {
      return error(cloud.on_rows(solver.solve(cloud.source(source).source)), exact, near);
    };
    const Error one = error_of(first), two = error_of(second);
    gain.worst = std::max({gain.worst, two.mean / one.mean, two.most / one.most});
    sum_of_first += one.mean, sum += two.mean;
  }
  gain.mean = sum / sum_of_first;
  return gain;
}

TEST(SecondOrderOnClouds, IsNeverMuchWorseFromAnySource) {
  for (Variant variant : all_variants)
    for (const auto& [name, mesh] :
         {std::pair(std::string("peanut"), sphere_like(peanut)), {"star", sphere_like(star)}}) {
      const Gain found = gain(mesh, variant);
      EXPECT_LT(found.worst, 1.1) << name << ", " << to_string(variant);
      EXPECT_LT(found.mean, 0.97) << name << ", " << to_string(variant);
    }
}

TEST(SecondOrderOnClouds, IsBetterOnSmoothSurfaces) {
  for (Variant variant : all_variants) EXPECT_LT(gain(split_icosphere(2562), variant).worst, 0.7) << to_string(variant);
}

}  // namespace
}  // namespace ahm::test
