// One object for maps, distances and paths, by rows: the same numbers as from the solvers that it is made of.
#include "ahm/surface/surface_solver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

trimesh::TriangleMeshSurface sphere_mesh() {
  const Mesh mesh = split_icosphere(642);
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

/// A flat 3 x 2 sheet of unit squares, 4 x 3 points.
trimesh::TriangleMeshSurface sheet() {
  std::vector<Vec3> positions;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) positions.push_back({static_cast<double>(x), static_cast<double>(y), 0});
  std::vector<Triangle> faces;
  for (Index y = 0; y < 2; ++y)
    for (Index x = 0; x < 3; ++x) {
      const Index a = 4 * y + x;
      faces.push_back({a, a + 1, a + 5});
      faces.push_back({a, a + 5, a + 4});
    }
  return trimesh::TriangleMeshSurface::build(positions, faces);
}

void expect_same(const RowLogMap& a, const RowLogMap& b) {
  ASSERT_EQ(a.status, b.status);
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    if (a.status[i] != Status::ok) continue;
    EXPECT_EQ(a.u[i], b.u[i]) << i;
    EXPECT_EQ(a.v[i], b.v[i]) << i;
    EXPECT_EQ(a.distance[i], b.distance[i]) << i;
  }
}

const std::vector<MethodOptions>& all_methods() {
  static const std::vector<MethodOptions> methods{PolarSolverOptions{}, HeatOptions{}, ExactSolverOptions{}};
  return methods;
}

TEST(SurfaceSolver, MakesTheMapsOfTheSolversBelow) {
  const auto mesh = sphere_mesh();
  const Row row(7);
  const Vec3 axis{0.3, 1, 0.2};
  const Source source = mesh.source(row, axis).source;
  const SurfaceMapOptions options{.u_axis = axis, .radius = 2};
  const std::array expected{
      mesh.to_rows(PolarMapSolver(mesh).log_map(row, axis, {.radius = 2})),
      mesh.to_rows(LogMapSolver(mesh.graph()).solve(source, {.radius = 2})),
      mesh.to_rows(ExactGeodesics(mesh).log_map(row, axis, {.radius = 2})),
  };
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const SurfaceSolver solver(mesh, all_methods()[k]);
    const SurfaceLogMap map = solver.log_map(7, options);
    expect_same(map, expected[k]);
    EXPECT_EQ(map.vertices.method(), solver.method());
    ASSERT_TRUE(map.source.row);
    EXPECT_EQ(*map.source.row, row);
  }
}

TEST(SurfaceSolver, ChoosesTheMethodThatSuitsTheSurface) {
  const auto mesh = sphere_mesh();
  const auto cloud = pointcloud::PointCloudSurface::build(random_sphere(2000).points);
  for (const Surface* surface : std::array<const Surface*, 2>{&mesh, &cloud}) {
    EXPECT_EQ(SurfaceSolver(*surface).method(), surface->suggested_method());
    EXPECT_EQ(log_map(*surface, 0).vertices.method(), surface->suggested_method());
  }
}

TEST(SurfaceSolver, MakesManyMapsAsOneByOne) {
  const auto mesh = sphere_mesh();
  for (const MethodOptions& method : all_methods()) {
    const SurfaceSolver solver(mesh, method);
    const std::vector<SurfaceLogMap> maps = solver.log_maps({0, Row(100), {0.0, 0.0, 1.0}});
    ASSERT_EQ(maps.size(), 3u);
    const std::array sources{Location(0), Location(100), Location(Vec3{0, 0, 1})};
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const SurfaceLogMap one = solver.log_map(sources[k]);
      ASSERT_EQ(maps[k].status, one.status);
      for (std::size_t i = 0; i < one.u.size(); ++i) {
        EXPECT_NEAR(maps[k].u[i], one.u[i], 1e-9);
        EXPECT_NEAR(maps[k].v[i], one.v[i], 1e-9);
      }
    }
  }
}

TEST(SurfaceSolver, StartsAnywhereOnTheSurface) {
  const SurfaceSolver solver(sheet());
  const SurfaceMapOptions along_x{.u_axis = Vec3{1, 0, 0}};
  const std::vector<std::pair<Location, Vec2>> places{
      {0, {0, 0}},
      {Row(5), {1, 1}},
      {{0.5, 0.25, 0.0}, {0.5, 0.25}},
      {Vec3{2.25, 1.5, 3}, {2.25, 1.5}},  // above the sheet
      {EdgePoint{Row(0), Row(1), 0.25}, {0.25, 0}},
      {FacePoint{0, {0.5, 0.25, 0.25}}, {0.5, 0.25}},
  };
  for (const auto& [place, at] : places) {
    const SurfaceLogMap map = solver.log_map(place, along_x);
    for (std::size_t i = 0; i < map.u.size(); ++i) {
      EXPECT_NEAR(map.u[i], static_cast<double>(i % 4) - at[0], 1e-12);
      EXPECT_NEAR(map.v[i], static_cast<double>(i / 4) - at[1], 1e-12);
    }
    const Sample corner = solver.at(map, {2.5, 1.75, 0.0});
    EXPECT_NEAR(corner.u, 2.5 - at[0], 1e-12);
    EXPECT_NEAR(corner.v, 1.75 - at[1], 1e-12);
    for (const double quality : solver.quality(map)) EXPECT_GT(quality, 0.99);
  }
}

TEST(SurfaceSolver, RefusesWhatTheSurfaceDoesNotHave) {
  const SurfaceSolver solver(sheet());
  for (const Location& place :
       {Location(12), Location(-1), Location(FacePoint{12, {1, 0, 0}}), Location(EdgePoint{Row(0), Row(11), 0.5}),
        Location(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0)}) {
    EXPECT_THROW(solver.log_map(place), InvalidArgument);
    EXPECT_THROW(solver.log_maps({0, place}), InvalidArgument);
    EXPECT_THROW(solver.distance(place), InvalidArgument);
    EXPECT_THROW(solver.path(0, place), InvalidArgument);
  }
  EXPECT_THROW(Location(5'000'000'000), InvalidArgument);
  EXPECT_THROW(solver.log_map(0, {.radius = -1}), InvalidArgument);
  EXPECT_THROW(solver.distance(0, {.radius = 0}), InvalidArgument);
}

TEST(SurfaceSolver, MeasuresDistancesFromTheNearestSource) {
  for (const MethodOptions& method : all_methods()) {
    const SurfaceSolver solver(sheet(), method);
    const std::vector<double> distance = solver.distance({0, 3});
    for (std::size_t i = 0; i < distance.size(); ++i) {
      const auto x = static_cast<double>(i % 4), y = static_cast<double>(i / 4);
      EXPECT_NEAR(distance[i], std::min(std::hypot(x, y), std::hypot(3 - x, y)), 1e-12);
    }
    const std::vector<double> near = solver.distance(0, {.radius = 1.5});
    for (std::size_t i = 0; i < near.size(); ++i)
      EXPECT_EQ(std::isnan(near[i]), std::hypot(static_cast<double>(i % 4), static_cast<double>(i / 4)) > 1.5) << i;
  }
}

TEST(SurfaceSolver, FindsPathsOnFacesAndOnTangentPlanes) {
  const SurfaceSolver faces(sheet());
  const SurfaceSolver planes(pointcloud::PointCloudSurface::build(flat_cloud(2000).points));
  const SurfacePath path = faces.path(0, 11);
  EXPECT_EQ(path.status, Status::ok);
  EXPECT_NEAR(path.length, std::hypot(3, 2), 1e-12);
  EXPECT_EQ(path.points.back(), (Vec3{3, 2, 0}));
  const SurfacePath ray = faces.trace(0, {3, 2, 0}, 2);
  EXPECT_TRUE(ray.complete);
  EXPECT_NEAR(ray.points.back()[0], 2 * 3 / std::hypot(3, 2), 1e-12);
  EXPECT_FALSE(faces.trace(0, {1, 0, 0}, 9).complete);

  const auto positions = planes.surface().positions();
  const SurfacePath flat = planes.path(3, 4);
  const Vec3 a = positions[3], b = positions[4];
  const double line = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  EXPECT_GE(flat.length, line * (1 - 1e-9));
  EXPECT_EQ(planes.trace(3, {1, 0, 0}, 0.05).status, Status::ok);
}

TEST(SurfaceSolver, HasLocalMapsOfAllRowsOrSome) {
  const SurfaceSolver solver(sheet());
  const RowLocalMaps all = solver.local_maps({.radius = 1.1});
  ASSERT_EQ(all.sources(), 12);
  const RowLocalMaps some = solver.local_maps({5, 0}, {.radius = 1.1});
  ASSERT_EQ(some.sources(), 2);
  EXPECT_EQ(some.indptr[1], all.indptr[6] - all.indptr[5]);
  EXPECT_EQ(some.indptr[1], 5);  // itself and four neighbors along the axes
}

TEST(SurfaceSolver, LeavesUnusedRowsWithoutLocalMaps) {
  std::vector<Vec3> positions{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const SurfaceSolver solver(trimesh::TriangleMeshSurface::build(positions, std::vector<Triangle>{{1, 2, 3}}));
  const RowLocalMaps maps = solver.local_maps({.radius = 2});
  EXPECT_EQ(maps.indptr, (std::vector<Offset>{0, 0, 3, 6, 9}));
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
