// Polar maps on every backend: planes, symmetries, exact maps, smooth surfaces, statuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "surface/surfaces.hpp"

namespace ahm::test {
namespace {

/// Largest difference of two maps, relative to the largest distance. Infinite if their statuses differ.
double relative_difference(const LogMap& a, const LogMap& b) {
  double largest = 0, farthest = 0;
  for (Vertex v(0); v.index < a.size(); ++v.index) {
    if (a.status(v) != b.status(v)) return INFINITY;
    if (a.status(v) != Status::ok) continue;
    largest = std::max(
        {largest, norm(vector_at(a, v.index) - vector_at(b, v.index)), std::abs(a.distance(v) - b.distance(v))});
    farthest = std::max(farthest, a.distance(v));
  }
  return largest / farthest;
}

// ------------------------------------------------------------------------------------------------ planes

void expect_plane(const Surface& surface, const SurfacePoint& source) {
  const Vec3 axis{0.3, 0.8, 0.1};
  const SurfaceSource placed = surface.source(source, axis);
  const RowLogMap rows = surface.to_rows(PolarMapSolver(surface).log_map(source, axis));
  double error = 0, diameter = 0;
  for (std::size_t r = 0; r < rows.u.size(); ++r) {
    if (rows.status[r] == Status::removed) continue;
    const Vec3 d = surface.positions()[r] - placed.position;
    error = std::max(error, std::hypot(dot(d, placed.frame->x) - rows.u[r], dot(d, placed.frame->y) - rows.v[r]));
    diameter = std::max(diameter, norm(d));
  }
  EXPECT_LT(error / diameter, 1e-12);
}

TEST(PolarMap, IsExactOnPlanes) {
  for (const Mesh& mesh : {flat_square(21), sliver_square(300), hexagon(9)})
    for (const SurfacePoint& source : {SurfacePoint{Row(7)}, SurfacePoint{FacePoint{40, {0.2, 0.3, 0.5}}}})
      expect_plane(surface_of(mesh), source);
  for (Polygons mesh : {voronoi_square(200), quad_grid(15), brick_wall(8)}) {
    tilt(mesh);
    expect_plane(surface_of(mesh), Row(11));
  }
  // The boundary is straight, so no shortest path bends.
  const auto cloud = pointcloud::PointCloudSurface::build(flat_square(21).positions);
  for (const Row source : {Row(5), Row(200)}) expect_plane(cloud, source);

  const grid::GridGraph grid({.shape = {17, 13}, .spacing = {0.5, 0.5}});
  const LogMap map = PolarMapSolver(grid).log_map(Vertex(30));
  for (Index i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(vector_at(map, i)[0], 0.5 * (i % 17 - 30 % 17), 1e-11);
    EXPECT_NEAR(vector_at(map, i)[1], 0.5 * (i / 17 - 30 / 17), 1e-11);
  }
}

/// In large meshes rays run along edges at angles as small as 1e-7. A path along such an edge is not noticeably longer.
TEST(PolarMap, IsExactWhereRaysNearlyFollowEdges) {
  for (unsigned seed : {1U, 2U}) {
    const auto surface = surface_of(flat_square(200, 0.24, seed));
    const Row source(20'100);
    const Vec3 axis{0.3, 0.8, 0.1};
    const SurfaceSource placed = surface.source(source, axis);
    const LogMap map = PolarMapSolver(surface, {.windows = 0}).log_map(source, axis);
    double error = 0;
    for (Index i = 0; i < map.size(); ++i) {
      const Vec3 d = surface.positions()[i] - placed.position;
      error = std::max(error, length(Vec2{dot(d, placed.frame->x), dot(d, placed.frame->y)} - vector_at(map, i)));
    }
    EXPECT_LT(error, 1e-12);
  }
}

// ------------------------------------------------------------------------------------------------ symmetries

RowLogMap rows_of(const Mesh& mesh, Index source, Offset windows) {
  const auto surface = surface_of(mesh);
  return surface.to_rows(PolarMapSolver(surface, {.windows = windows}).log_map(Row(source), Vec3{0, 0, 1}));
}

TEST(PolarMap, DoesNotDependOnTheOrderOfRows) {
  const Mesh mesh = torus(900);
  std::vector<Index> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  Mesh other = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) other.positions[order[i]] = mesh.positions[i];
  for (Triangle& t : other.faces)
    for (Index& corner : t) corner = order[corner];
  std::shuffle(other.faces.begin(), other.faces.end(), std::mt19937(6));
  const RowLogMap a = rows_of(mesh, 4, 3000), b = rows_of(other, order[4], 3000);
  // Of equally long paths a different one may be taken, also for the vertices behind it.
  double largest_error = 0, turned = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index j = order[i];
    largest_error = std::max(largest_error, std::abs(a.distance[i] - b.distance[j]));
    turned += std::hypot(a.u[i] - b.u[j], a.v[i] - b.v[j]) > 0.01;
  }
  EXPECT_LT(largest_error, 0.01);
  EXPECT_LT(turned, 0.02 * static_cast<double>(order.size()));
}

TEST(PolarMap, IsMirroredWithTheSurface) {
  const Mesh mesh = torus(900);
  Mesh other = mesh;
  for (Vec3& p : other.positions) p[0] = -p[0];
  for (Triangle& t : other.faces) std::swap(t[1], t[2]);
  const RowLogMap a = rows_of(mesh, 4, 0), b = rows_of(other, 4, 0);
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    EXPECT_NEAR(a.u[i], b.u[i], 0.01);
    EXPECT_NEAR(a.v[i], -b.v[i], 0.01);
  }
}

TEST(PolarMap, DoesNotDependOnTheNumberOfThreads) {
  const auto surface = surface_of(torus(6000));
  const LogMap a = PolarMapSolver(surface, {.threads = 1}).log_map(Row(4)),
               b = PolarMapSolver(surface, {.threads = 4}).log_map(Row(4));
  EXPECT_EQ(relative_difference(a, b), 0);
}

TEST(PolarMap, DoesNotDependOnOtherComponents) {
  Mesh mesh = torus(20000);  // more vertices than the least number of windows serves
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-1e-3, 1e-3);
  for (Vec3& p : mesh.positions)
    p = p + Vec3{offset(random), offset(random), offset(random)};  // no paths of equal length
  const auto alone = surface_of(mesh), together = surface_of(joined(mesh, torus(5000), {9, 9, 9}));
  const RowLogMap a = alone.to_rows(PolarMapSolver(alone).log_map(Row(4))),
                  b = together.to_rows(PolarMapSolver(together).log_map(Row(4)));
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    ASSERT_NEAR(a.u[i], b.u[i], 1e-12) << i;
    ASSERT_NEAR(a.v[i], b.v[i], 1e-12) << i;
  }
}

// ------------------------------------------------------------------------------------------------ exact maps

TEST(PolarMap, IsTheExactMapWhereWindowsReach) {
  for (const Mesh& mesh : {torus(900), folded_strip(15), holed_square(21)}) {
    const auto surface = surface_of(mesh);
    const ExactGeodesics geodesics(surface);
    const Vec3 axis{0.1, 0.2, 0.9};
    for (const SurfacePoint& source : {SurfacePoint{Row(10)}, SurfacePoint{FacePoint{33, {0.2, 0.3, 0.5}}},
                                       SurfacePoint{FacePoint{50, {0.5, 0, 0.5}}}}) {
      const LogMap polar = PolarMapSolver(surface).log_map(source, axis, {.frames = true}),
                   exact = geodesics.log_map(source, axis, {.frames = true});
      EXPECT_LT(relative_difference(exact, polar), 1e-12);
      for (std::size_t i = 0; i < exact.frames().size(); ++i)
        EXPECT_NEAR(polar.frames()[i], exact.frames()[i], 1e-9) << i / 4;
    }
    constexpr Offset some = 4000;  // windows that end before the farthest vertex
    const LogMap polar = PolarMapSolver(surface, {.windows = some}).log_map(Row(10)),
                 whole = geodesics.log_map(Row(10)), exact = geodesics.log_map(Row(10), {}, {.max_windows = some});
    for (Index i = 0; i < exact.size(); ++i)
      if (exact.status(Vertex(i)) == Status::ok) EXPECT_LT(norm(vector_at(polar, i) - vector_at(whole, i)), 1e-12);
    EXPECT_GT(exact.count(Status::ok), 50);
    EXPECT_EQ(polar.count(Status::ok), polar.size());
  }
}

TEST(ExactMap, MayEndAtANumberOfVertices) {
  const auto surface = surface_of(torus(900));
  const ExactGeodesics geodesics(surface);
  const LogMap whole = geodesics.log_map(Row(10));
  for (const Index count : {1, 12, 60}) {
    const LogMap some = geodesics.log_map(Row(10), {}, {.max_vertices = count});
    EXPECT_GE(some.count(Status::ok), count);
    EXPECT_LT(some.count(Status::ok), 2 * count + 20);
    double farthest = 0;
    for (Vertex v(0); v.index < some.size(); ++v.index)
      if (some.status(v) == Status::ok) {
        farthest = std::max(farthest, some.distance(v));
        EXPECT_EQ(some.distance(v), whole.distance(v));
        EXPECT_EQ(vector_at(some, v.index), vector_at(whole, v.index));
      }
    for (Vertex v(0); v.index < some.size(); ++v.index)  // no nearer vertex is missing
      if (some.status(v) != Status::ok) EXPECT_GE(whole.distance(v), farthest);
  }
}

TEST(PolarMap, IsCloseToTheExactMapWhereItsErrorEstimateIsSmall) {
  const auto surface = surface_of(torus(6000));
  const LogMap polar = PolarMapSolver(surface, {.windows = 0}).log_map(Row(100)),
               exact = ExactGeodesics(surface).log_map(Row(100));
  Index small = 0, right = 0;
  for (Vertex v(0); v.index < polar.size(); ++v.index) {
    const double d = exact.distance(v);
    if (!(d > 0.1) || polar.error_estimate()[v.index] > 0.1 * polar.distance(v)) continue;
    ++small;
    right += norm(vector_at(polar, v.index) - vector_at(exact, v.index)) < 0.1 * d;
  }
  EXPECT_GT(small, 0.7 * polar.size());
  EXPECT_GT(right, 0.97 * small);
}

TEST(PolarMap, OfAMoebiusBandIsMirroredAfterATurn) {
  const auto surface = surface_of(moebius_mesh(60, 9));
  const LogMap polar = PolarMapSolver(surface, {.windows = 0}).log_map(Row(30)),
               exact = ExactGeodesics(surface).log_map(Row(30));
  Index right = 0;
  for (Index i = 0; i < polar.size(); ++i)
    right += norm(vector_at(polar, i) - vector_at(exact, i)) <= 0.1 * exact.distance(Vertex(i));
  EXPECT_GT(right, 0.9 * polar.size());
}

// ------------------------------------------------------------------------------------------------ smooth surfaces

TEST(PolarMap, ConvergesOnTheSphere) {
  // Root mean square of the vector error on the unit sphere within 0.8 pi.
  const auto error = [](Index parts, Offset windows) {
    const Mesh mesh = icosphere(parts);
    const RowLogMap rows = rows_of(mesh, 17, windows);
    const Vec3 p = mesh.positions[17], axis{0, 0, 1}, x = normalized(axis - dot(axis, p) * p), y = cross(p, x);
    return sphere_error(mesh.positions, rows.u, rows.v, 17, x, y, 0.8 * std::numbers::pi).rms;
  };
  EXPECT_LT(error(48, 0), error(12, 0) / 12);
  EXPECT_LT(error(48, 0), 1e-3);
  // Windows are exact on the triangles. The log map of the polyhedron approaches that of the sphere more slowly.
  EXPECT_LT(error(48, 20000), error(12, 20000) / 2);
}

TEST(PolarMap, TransportsDirectionsToTheGradientOfTheDistance) {
  const Mesh mesh = icosphere(24);
  const auto triangle_mesh = surface_of(mesh);
  const auto cloud = pointcloud::PointCloudSurface::build(mesh.positions);
  for (const Surface* surface : std::initializer_list<const Surface*>{&triangle_mesh, &cloud})
    for (const Offset windows : {0, 3000}) {
      const LogMap map = PolarMapSolver(*surface, {.windows = windows}).log_map(Row(17), {}, {.frames = true});
      const std::vector<Vec3> gradients = distance_gradients(*surface, map, surface->to_rows(map));
      const Vec3& p = mesh.positions[17];
      for (std::size_t r = 0; r < gradients.size(); ++r)
        if (const Vec3& q = mesh.positions[r]; r != 17 && dot(p, q) >= -0.9)
          EXPECT_GT(dot(gradients[r], normalized(dot(p, q) * q - p)), 0.99) << r;
    }
}

// ------------------------------------------------------------------------------------------------ statuses

TEST(PolarMap, HasAStatusWhereItHasNoCoordinates) {
  const Mesh one = icosphere(6);
  const auto surface = surface_of(joined(one, one, {5, 0, 0}));
  const PolarMapSolver solver(surface);
  const LogMap whole = solver.log_map(Row(7)), near = solver.log_map(Row(7), {}, {.radius = 1});
  for (Vertex v(0); v.index < whole.size(); ++v.index) {
    const Status expected = v.index < one.vertices() ? Status::ok : Status::disconnected;
    EXPECT_EQ(whole.status(v), expected);
    EXPECT_EQ(near.status(v), whole.distance(v) > 1 ? Status::beyond_radius : expected);
    EXPECT_EQ(std::isnan(vector_at(near, v.index)[0]), near.status(v) != Status::ok);
    EXPECT_EQ(std::isnan(near.error_estimate()[v.index]), near.status(v) != Status::ok);
  }
}

TEST(PolarMap, OfSeveralVerticesHasANearestSource) {
  const auto surface = surface_of(icosphere(9));
  const std::vector<Vertex> sources{Vertex(3), Vertex(70), Vertex(200)};
  const LogMap map = PolarMapSolver(surface).log_map(Source::at_vertices(sources));
  for (Index i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(norm(vector_at(map, i)), map.distance(Vertex(i)), 1e-12);
    EXPECT_TRUE(map.nearest()[i] >= 0 && map.nearest()[i] < 3);
  }
}

TEST(PolarMap, RefusesVolumesAndInvalidArguments) {
  const CsrGraph volume(lattice3(4).data);
  EXPECT_THROW(PolarMapSolver{volume}, InvalidArgument);
  const auto surface = surface_of(icosphere(3));
  const PolarMapSolver solver(surface), of_graph(surface.graph());
  EXPECT_THROW(solver.log_map(Row(0), {}, {.radius = 0}), InvalidArgument);
  EXPECT_THROW(solver.log_map(Row(9999)), InvalidArgument);
  EXPECT_THROW(of_graph.log_map(Row(0)), InvalidArgument);  // a graph has no rows
}

}  // namespace
}  // namespace ahm::test
