// Local maps by row are the rows of whole maps.
#include "ahm/surface/row_local_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

constexpr double radius = 0.25;

/// Points beside a sphere, between many of which heat finds ways shorter than the straight line.
pointcloud::PointCloudSurface noisy_sphere() {
  std::vector<Vec3> points = random_sphere(3000).points;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(1, 0.01);
  for (Vec3& p : points) {
    const double factor = normal(random);
    for (double& x : p) x *= factor;
  }
  return pointcloud::PointCloudSurface::build(points);
}

std::vector<Vertex> sources_on(const Surface& surface) {
  std::vector<Vertex> result;
  for (Index i = 5; i < surface.graph().size(); i += surface.graph().size() / 12) result.emplace_back(i);
  return result;
}

/// @param margin  how far distances may be off, radii
/// @return how many are those of the straight line
Index expect_rows_of_whole_maps(const Surface& surface, double margin) {
  const std::vector<Vertex> sources = sources_on(surface);
  const RowLocalMaps maps = row_local_maps(surface, sources, {.radius = radius});
  const LogMapSolver solver(surface.graph());
  Index at_line = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const Vec3 start = surface.graph().frame(sources[s].index)->origin;
    const RowLogMap whole = surface.to_rows(solver.solve(Source::at_vertex(sources[s]), {.radius = radius}));
    EXPECT_TRUE(std::is_sorted(maps.distances.begin() + maps.indptr[s], maps.distances.begin() + maps.indptr[s + 1]));
    Offset inside = 0;
    for (double d : whole.distance) inside += d < radius * (1 - margin);
    EXPECT_LE(inside, maps.indptr[s + 1] - maps.indptr[s]);
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
      const Vec3 there = surface.graph().frame(surface.vertex(maps.neighbors[e]).index)->origin;
      const double line = std::hypot(there[0] - start[0], there[1] - start[1], there[2] - start[2]);
      EXPECT_GE(maps.distances[e], line * (1 - 1e-9));
      at_line += maps.distances[e] < line * (1 + 1e-9);
      const double d = whole.distance[maps.neighbors[e].index];
      if (std::isnan(d))  // only at the rim
        EXPECT_GT(maps.distances[e], radius * (1 - margin));
      else
        EXPECT_NEAR(maps.distances[e], d, margin * radius);
    }
  }
  return at_line;
}

TEST(RowLocalMaps, AreTheRowsOfWholeMaps) {
  EXPECT_GT(expect_rows_of_whole_maps(noisy_sphere(), 1e-4), 50);
  const Mesh mesh = torus(12000);  // whole maps of smaller ones go by the midpoints of edges, too
  expect_rows_of_whole_maps(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces), 1e-9);
}

// Of all within a large radius, and of as many as there must be.
TEST(RowLocalMaps, HoldTheNearestByTheSameDistances) {
  const auto cloud = noisy_sphere();
  const std::vector<Vertex> sources = sources_on(cloud);
  const RowLocalMaps all = row_local_maps(cloud, sources, {.radius = 2 * radius}),
                     nearest = row_local_maps(cloud, sources, {.k = 40});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    ASSERT_EQ(nearest.indptr[s + 1] - nearest.indptr[s], 40);
    for (Offset k = 0; k < 40; ++k)
      EXPECT_NEAR(nearest.distances[nearest.indptr[s] + k], all.distances[all.indptr[s] + k], 1e-4 * radius);
  }
}

}  // namespace
}  // namespace ahm::test
