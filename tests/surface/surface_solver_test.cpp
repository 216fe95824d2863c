// Maps, distances and paths by rows: the numbers of the solvers below, and rows instead of vertices.
#include "ahm/surface/surface_solver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "ahm/surface/row_map.hpp"
#include "ahm/util/vec.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

// ------------------------------------------------------------------------------------------------ rows and vertices

/// Row 0 has two vertices, row 1 has none, rows 2 and 3 share vertex 0; vertex 3 has no row.
RowMap example_rows() {
  const RowVertex pairs[] = {{Row(3), Vertex(0)}, {Row(0), Vertex(2)}, {Row(2), Vertex(0)}, {Row(0), Vertex(1)}};
  return RowMap(4, 4, pairs);
}

TEST(RowMap, ConvertsRowsAndVertices) {
  const RowMap map = example_rows();
  EXPECT_EQ(map.row_count(), 4);
  EXPECT_EQ(map.vertex_count(), 4);
  ASSERT_EQ(map.vertices(Row(0)).size(), 2U);  // in the order of the pairs
  EXPECT_EQ(map.vertices(Row(0))[0], Vertex(2));
  EXPECT_EQ(map.vertices(Row(0))[1], Vertex(1));
  EXPECT_EQ(map.vertex(Row(0)), Vertex(2));
  EXPECT_EQ(map.vertex(Row(1)), std::nullopt);
  EXPECT_TRUE(map.vertices(Row(1)).empty());
  EXPECT_EQ(map.row(Vertex(0)), Row(2));  // the first of two rows
  EXPECT_EQ(map.row(Vertex(1)), Row(0));
  EXPECT_EQ(map.row(Vertex(3)), std::nullopt);
  const RowVertex pairs[] = {{Row(2), Vertex(0)}, {Row(1), Vertex(3)}, {Row(3), Vertex(1)}};
  EXPECT_EQ(first_vertex(RowMap(4, 4, pairs)), Vertex(3));
}

TEST(RowMap, TheLeastVertexOfARowIsTheFirstOfEqualOnesAndNeverNan) {
  const RowMap map = example_rows();
  const auto least = [&](Row row, std::vector<double> values) {
    return map.least(row, [&](Vertex v) { return values[v.index]; });
  };
  EXPECT_EQ(least(Row(0), {0, 1, 2, 0}), Vertex(1));
  EXPECT_EQ(least(Row(0), {0, 2, 1, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, 5, 5, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, 5, NAN, 0}), Vertex(1));
  EXPECT_EQ(least(Row(0), {0, NAN, INFINITY, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, NAN, NAN, 0}), std::nullopt);
  EXPECT_EQ(least(Row(1), {0, 0, 0, 0}), std::nullopt);
}

TEST(RowMap, RefusesNumbersOutOfRange) {
  const RowMap map = example_rows();
  EXPECT_THROW(map.vertices(Row(4)), InvalidArgument);
  EXPECT_THROW(map.vertex(Row(-1)), InvalidArgument);
  EXPECT_THROW(map.row(Vertex(4)), InvalidArgument);
  EXPECT_THROW(first_vertex(RowMap(4, 4, {})), InvalidArgument);
  const RowVertex bad[] = {{Row(0), Vertex(9)}};
  EXPECT_THROW(RowMap(1, 1, bad), InvalidArgument);
}

// ------------------------------------------------------------------------------------------------ local maps

constexpr double local_radius = 0.25;

/// Points near a sphere. Heat distances between many of them are shorter than the straight line.
pointcloud::PointCloudSurface noisy_sphere() {
  std::vector<Vec3> points = random_sphere(3000).points;
  std::mt19937_64 random(3);
  std::normal_distribution<double> factor(1, 0.01);
  for (Vec3& p : points) p = factor(random) * p;
  return pointcloud::PointCloudSurface::build(points);
}

std::vector<Vertex> sources_on(const Surface& surface) {
  std::vector<Vertex> result;
  for (Index i = 5; i < surface.graph().size(); i += surface.graph().size() / 12) result.emplace_back(i);
  return result;
}

/// @param margin  tolerance of distances, in radii
/// @return number of distances that are those of the straight line
Index expect_rows_of_whole_maps(const Surface& surface, double margin) {
  const std::vector<Vertex> sources = sources_on(surface);
  const RowLocalMaps maps = row_local_maps(surface, sources, {.radius = local_radius, .method = Method::heat});
  const LogMapSolver solver(surface.graph());
  Index straight = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const Offset begin = maps.indptr[s], end = maps.indptr[s + 1];
    const Vec3 start = surface.graph().frame(sources[s].index)->origin;
    const RowLogMap whole = surface.to_rows(solver.solve(Source::at_vertex(sources[s]), {.radius = local_radius}));
    EXPECT_TRUE(std::is_sorted(maps.distances.begin() + begin, maps.distances.begin() + end));
    EXPECT_LE(std::ranges::count_if(whole.distance, [&](double d) { return d < local_radius * (1 - margin); }),
              end - begin);
    for (Offset e = begin; e < end; ++e) {
      const double line = distance(surface.graph().frame(surface.vertex(maps.neighbors[e]).index)->origin, start),
                   d = whole.distance[maps.neighbors[e].index];
      EXPECT_GE(maps.distances[e], line * (1 - 1e-9));
      straight += maps.distances[e] < line * (1 + 1e-9);
      if (std::isnan(d))  // only at the radius
        EXPECT_GT(maps.distances[e], local_radius * (1 - margin));
      else
        EXPECT_NEAR(maps.distances[e], d, margin * local_radius);
    }
  }
  return straight;
}

TEST(RowLocalMaps, AreTheRowsOfWholeMaps) {
  EXPECT_GT(expect_rows_of_whole_maps(noisy_sphere(), 1e-4), 50);
  // Whole maps of smaller meshes also use the midpoints of edges.
  expect_rows_of_whole_maps(surface_of(torus(12000)), 1e-9);
}

TEST(RowLocalMaps, OfTheNearestAreTheFirstOfALargeRadius) {
  const auto cloud = noisy_sphere();
  const std::vector<Vertex> sources = sources_on(cloud);
  const RowLocalMaps all = row_local_maps(cloud, sources, {.radius = 2 * local_radius, .method = Method::heat}),
                     nearest = row_local_maps(cloud, sources, {.k = 40, .method = Method::heat});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    ASSERT_EQ(nearest.indptr[s + 1] - nearest.indptr[s], 40);
    for (Offset k = 0; k < 40; ++k)
      EXPECT_NEAR(nearest.distances[nearest.indptr[s] + k], all.distances[all.indptr[s] + k], 1e-4 * local_radius);
  }
}

// ------------------------------------------------------------------------------------------------ solver

/// A flat 3 x 2 sheet of unit squares. Row 4 y + x is the point (x, y).
trimesh::TriangleMeshSurface sheet() {
  return surface_of(triangles(quads(3, 4, Columns::open, [](Index y, Index x) { return Vec3{1.0 * x, 1.0 * y, 0}; })));
}
Vec2 on_sheet(std::size_t row) { return {static_cast<double>(row % 4), static_cast<double>(row / 4)}; }

const std::vector<MethodOptions> all_methods{PolarSolverOptions{}, HeatOptions{}, ExactSolverOptions{}};

// A solver of a temporary surface would refer to it after its end. A surface that is not constant is moved into the solver.
using pointcloud::PointCloudSurface;
static_assert(std::is_constructible_v<SurfaceSolver, const PointCloudSurface&>);
static_assert(std::is_constructible_v<SurfaceSolver, PointCloudSurface>);
static_assert(!std::is_constructible_v<SurfaceSolver, const PointCloudSurface>);
static_assert(!std::is_constructible_v<LogMapSolver, const CsrGraph> &&
              !std::is_constructible_v<LogMapSolver, CsrGraph>);
static_assert(!std::is_constructible_v<PolarMapSolver, const PointCloudSurface>);
static_assert(!std::is_constructible_v<ExactGeodesics, const PointCloudSurface>);

TEST(SurfaceSolver, MapsAreThoseOfTheSolversBelow) {
  const auto mesh = surface_of(split_icosphere(642));
  const Row row(7);
  const Vec3 axis{0.3, 1, 0.2};
  const std::array expected{
      mesh.to_rows(PolarMapSolver(mesh).log_map(row, axis, {.radius = 2})),
      mesh.to_rows(LogMapSolver(mesh.graph()).solve(mesh.source(row, axis).source, {.radius = 2})),
      mesh.to_rows(ExactGeodesics(mesh).log_map(row, axis, {.radius = 2})),
  };
  for (std::size_t k = 0; k < expected.size(); ++k) {
    SCOPED_TRACE(k);
    const SurfaceSolver solver(mesh, all_methods[k]);
    const SurfaceLogMap map = solver.log_map(7, {.u_axis = axis, .radius = 2});
    ASSERT_EQ(map.status, expected[k].status);
    for (std::size_t i = 0; i < map.u.size(); ++i) {
      if (map.status[i] != Status::ok) continue;
      EXPECT_EQ(map.u[i], expected[k].u[i]) << i;
      EXPECT_EQ(map.v[i], expected[k].v[i]) << i;
      EXPECT_EQ(map.distance[i], expected[k].distance[i]) << i;
    }
    EXPECT_EQ(map.vertices.method(), solver.method());
    EXPECT_EQ(map.source.row, row);
    const std::array sources{Location(0), Location(100), Location(Vec3{0, 0, 1})};
    const std::vector<SurfaceLogMap> maps = solver.log_maps({0, Row(100), {0.0, 0.0, 1.0}});
    ASSERT_EQ(maps.size(), sources.size());
    for (std::size_t s = 0; s < maps.size(); ++s) {
      const SurfaceLogMap one = solver.log_map(sources[s]);
      ASSERT_EQ(maps[s].status, one.status);
      for (std::size_t i = 0; i < one.u.size(); ++i) {
        EXPECT_NEAR(maps[s].u[i], one.u[i], 1e-9);
        EXPECT_NEAR(maps[s].v[i], one.v[i], 1e-9);
      }
    }
  }
}

TEST(SurfaceSolver, ChoosesTheSuggestedMethod) {
  const auto mesh = surface_of(split_icosphere(642));
  const auto cloud = pointcloud::PointCloudSurface::build(random_sphere(2000).points);
  for (const Surface* surface : std::array<const Surface*, 2>{&mesh, &cloud}) {
    EXPECT_EQ(SurfaceSolver(*surface).method(), surface->suggested_method());
    EXPECT_EQ(log_map(*surface, 0).vertices.method(), surface->suggested_method());
  }
}

TEST(SurfaceSolver, StartsAtAnyLocation) {
  const SurfaceSolver solver(sheet());
  const std::vector<std::pair<Location, Vec2>> locations{
      {0, {0, 0}},
      {Row(5), {1, 1}},
      {{0.5, 0.25, 0.0}, {0.5, 0.25}},
      {Vec3{2.25, 1.5, 3}, {2.25, 1.5}},  // above the sheet
      {EdgePoint{Row(0), Row(1), 0.25}, {0.25, 0}},
      {FacePoint{0, {0.5, 0.25, 0.25}}, {0.5, 0.25}},
  };
  for (const auto& [location, start] : locations) {
    const SurfaceLogMap map = solver.log_map(location, {.u_axis = Vec3{1, 0, 0}});
    for (std::size_t i = 0; i < map.u.size(); ++i)
      EXPECT_LT(norm(Vec2{map.u[i], map.v[i]} - (on_sheet(i) - start)), 1e-12);
    const Sample sample = solver.at(map, {2.5, 1.75, 0.0});
    EXPECT_NEAR(sample.u, 2.5 - start[0], 1e-12);
    EXPECT_NEAR(sample.v, 1.75 - start[1], 1e-12);
    for (const double quality : solver.quality(map)) EXPECT_GT(quality, 0.99);
  }
}

TEST(SurfaceSolver, RefusesLocationsThatTheSurfaceDoesNotHave) {
  const SurfaceSolver solver(sheet());
  for (const Location& location : {Location(12), Location(-1), Location(FacePoint{12, {1, 0, 0}}),
                                   Location(EdgePoint{Row(0), Row(11), 0.5}), Location(std::nan(""), 0.0, 0.0)}) {
    EXPECT_THROW(solver.log_map(location), InvalidArgument);
    EXPECT_THROW(solver.log_maps({0, location}), InvalidArgument);
    EXPECT_THROW(solver.distance(location), InvalidArgument);
    EXPECT_THROW(solver.path(0, location), InvalidArgument);
  }
  EXPECT_THROW(Location(5'000'000'000), InvalidArgument);
  EXPECT_THROW(solver.log_map(0, {.radius = -1}), InvalidArgument);
  EXPECT_THROW(solver.distance(0, {.radius = 0}), InvalidArgument);
}

TEST(SurfaceSolver, DistancesAreThoseToTheNearestSource) {
  for (const MethodOptions& method : all_methods) {
    const SurfaceSolver solver(sheet(), method);
    const std::vector<double> two = solver.distance({0, 3}), within = solver.distance(0, {.radius = 1.5});
    for (std::size_t i = 0; i < two.size(); ++i) {
      const double first = norm(on_sheet(i)), second = norm(on_sheet(i) - on_sheet(3));
      EXPECT_NEAR(two[i], std::min(first, second), 1e-12);
      EXPECT_EQ(std::isnan(within[i]), first > 1.5) << i;
    }
    if (solver.method() != Method::exact) EXPECT_EQ(distance(solver.surface(), {0, 3}), two);
  }
  EXPECT_THROW(distance(SurfaceSolver(sheet()).surface(), {Location(12)}), InvalidArgument);
}

TEST(SurfaceSolver, PathsRunOnFacesAndTangentPlanes) {
  const SurfaceSolver faces(sheet());
  const SurfacePath path = faces.path(0, 11);
  EXPECT_EQ(path.status, Status::ok);
  EXPECT_NEAR(path.length, std::hypot(3, 2), 1e-12);
  EXPECT_EQ(path.points.back(), (Vec3{3, 2, 0}));
  const SurfacePath ray = faces.trace(0, {3, 2, 0}, 2);
  EXPECT_TRUE(ray.complete);
  EXPECT_NEAR(ray.points.back()[0], 2 * 3 / std::hypot(3, 2), 1e-12);
  EXPECT_FALSE(faces.trace(0, {1, 0, 0}, 9).complete);

  const SurfaceSolver planes(pointcloud::PointCloudSurface::build(flat_cloud(2000).points));
  const auto positions = planes.surface().positions();
  EXPECT_GE(planes.path(3, 4).length, distance(positions[3], positions[4]) * (1 - 1e-9));
  EXPECT_EQ(planes.trace(3, {1, 0, 0}, 0.05).status, Status::ok);
}

TEST(SurfaceSolver, LocalMapsAreOfAllOrSomeRows) {
  const SurfaceSolver solver(sheet());
  const RowLocalMaps all = solver.local_maps({.radius = 1.1}), some = solver.local_maps({5, 0}, {.radius = 1.1});
  ASSERT_EQ(all.sources(), 12);
  ASSERT_EQ(some.sources(), 2);
  EXPECT_EQ(some.indptr[1], all.indptr[6] - all.indptr[5]);
  EXPECT_EQ(some.indptr[1], 5);  // the source and four neighbors along the axes
  const SurfaceSolver with_unused_row(surface_of(Mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 2, 3}}, {}}));
  EXPECT_EQ(with_unused_row.local_maps({.radius = 2}).indptr, (std::vector<Offset>{0, 0, 3, 6, 9}));
}

TEST(SurfaceSolver, CanBeMovedAndSharesItsSurface) {
  const auto shared = std::make_shared<const trimesh::TriangleMeshSurface>(sheet());
  SurfaceSolver solver(shared);
  EXPECT_EQ(&solver.surface(), shared.get());
  const SurfaceSolver moved = std::move(solver);
  EXPECT_NEAR(moved.log_map(0).distance[11], std::hypot(3, 2), 1e-12);
}

}  // namespace
}  // namespace ahm::test
