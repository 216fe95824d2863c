// What every surface promises, whatever it is made of.
#include "ahm/surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

using pointcloud::PointCloudSurface;
using polymesh::Discretization;
using polymesh::PolygonMeshSurface;
using trimesh::TriangleMeshSurface;

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

PolygonMeshSurface polygons(const Mesh& mesh, Discretization discretization) {
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  for (const Triangle& t : mesh.faces) {
    corners.insert(corners.end(), t.begin(), t.end());
    begin.push_back(static_cast<Offset>(corners.size()));
  }
  return PolygonMeshSurface::build(mesh.positions, begin, corners, {.discretization = discretization});
}

/// Calls visit(surface) with every kind of surface that has these faces.
void for_each_mesh_surface(const Mesh& mesh, const std::function<void(const Surface&)>& visit) {
  visit(TriangleMeshSurface::build(mesh.positions, mesh.faces));
  visit(polygons(mesh, Discretization::polygons));
  visit(polygons(mesh, Discretization::refined));
}

double largest_difference(const RowLogMap& a, const RowLogMap& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i) worst = std::max(worst, std::hypot(a.u[i] - b.u[i], a.v[i] - b.v[i]));
  return worst;
}

TEST(Surface, ASourceAtARowIsThatAtACornerOfAFlatFace) {
  const Mesh mesh = holed_square(12);
  const Vec3 along{mesh.positions[1][0] - mesh.positions[0][0], mesh.positions[1][1] - mesh.positions[0][1],
                   mesh.positions[1][2] - mesh.positions[0][2]};
  for_each_mesh_surface(mesh, [&](const Surface& surface) {
    const LogMapSolver solver(surface.graph());
    for (std::size_t corner : {0U, 2U}) {
      const Row row(mesh.faces[50][corner]);
      FacePoint point{50, {0, 0, 0}};
      point.barycentric[corner] = 1;
      const SurfaceSource at_row = surface.source(row, along), in_face = surface.source(point, along);
      EXPECT_EQ(at_row.row, row);
      EXPECT_FALSE(in_face.row);
      EXPECT_LT(distance(at_row.position, in_face.position), 1e-14);
      EXPECT_LT(distance(at_row.frame->x, in_face.frame->x), 1e-12);
      EXPECT_LT(largest_difference(surface.to_rows(solver.solve(at_row.source)),
                                   surface.to_rows(solver.solve(in_face.source))),
                1e-10);
    }
  });
}

TEST(Surface, AnEdgePointLiesOnTheEdgeAndLooksAlongIt) {
  const Mesh mesh = holed_square(12);
  for_each_mesh_surface(mesh, [&](const Surface& surface) {
    const auto [a, b, c] = mesh.faces[40];
    const EdgePoint point{Row(c), Row(a), 0.25};
    const SurfaceSource source = surface.source(point);
    Vec3 wanted, along;
    for (int k = 0; k < 3; ++k) {
      wanted[k] = 0.75 * mesh.positions[c][k] + 0.25 * mesh.positions[a][k];
      along[k] = (mesh.positions[a][k] - mesh.positions[c][k]) / distance(mesh.positions[a], mesh.positions[c]);
    }
    EXPECT_LT(distance(source.position, wanted), 1e-14);
    EXPECT_LT(distance(surface.position(point), wanted), 1e-14);
    EXPECT_LT(distance(source.frame->x, along), 1e-12);
    const LogMap map = LogMapSolver(surface.graph()).solve(source.source);
    const Sample there = surface.at(map, point), end = surface.at(map, Row(a));
    EXPECT_NEAR(std::hypot(there.u, there.v), 0, 1e-10);
    EXPECT_NEAR(end.u, 0.75 * distance(mesh.positions[a], mesh.positions[c]), 1e-10);
    EXPECT_NEAR(end.v, 0, 1e-10);
    EXPECT_THROW(surface.source(EdgePoint{Row(a), Row(a), 0.5}), InvalidArgument);
    EXPECT_THROW(surface.source(EdgePoint{Row(a), Row(b), 1.5}), InvalidArgument);
  });
}

TEST(Surface, CornersHaveTheValuesOfTheirRowsOnAFlatMesh) {
  Mesh mesh = holed_square(10);
  for (std::size_t f = 0; f < mesh.faces.size(); f += 3) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
  for_each_mesh_surface(mesh, [&](const Surface& surface) {
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(5)).source);
    const RowLogMap rows = surface.to_rows(map);
    const std::vector<Vec2> corners = surface.to_corners(map);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(corners[3 * f + c][0], rows.u[mesh.faces[f][c]], 1e-9);
        ASSERT_NEAR(corners[3 * f + c][1], rows.v[mesh.faces[f][c]], 1e-9);
      }
  });
}

/// Three squares that share the edge from row 0 to row 1, each of two triangles.
Mesh three_pages() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}};
  for (Index p : {2, 4, 6}) {
    mesh.faces.push_back({0, p, p + 1});
    mesh.faces.push_back({0, p + 1, 1});
  }
  return mesh;
}

TEST(Surface, OfTheCopiesOfACutRowTheOneNearestToTheSourceCounts) {
  const Mesh mesh = three_pages();
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.non_manifold = NonManifold::split});
  EXPECT_EQ(surface.rows().vertices(Row(0)).size(), 3U);
  const LogMapSolver solver(surface.graph());
  for (Index page : {2, 4, 6}) {
    const LogMap map = solver.solve(surface.source(Row(page)).source);
    const RowLogMap rows = surface.to_rows(map);
    for (Index r : {0, 1}) {
      ASSERT_EQ(rows.status[r], Status::ok);
      ASSERT_TRUE(rows.vertex[r]);
      EXPECT_EQ(surface.rows().row(*rows.vertex[r]), Row(r));
      EXPECT_EQ(rows.distance[r], map.distance(*rows.vertex[r]));
      for (Vertex v : surface.rows().vertices(Row(r)))
        EXPECT_FALSE(map.status(v) == Status::ok && map.distance(v) < rows.distance[r]);
    }
    EXPECT_NEAR(rows.distance[0], distance(mesh.positions[page], mesh.positions[0]), 1e-9);  // a page is flat
  }
}

TEST(Surface, NumbersOfVerticesFollowTheCoordinatesToTheRows) {
  const Mesh mesh = three_pages();
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.non_manifold = NonManifold::split});
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(2)).source);
  const RowLogMap rows = surface.to_rows(map);
  std::vector<double> distances;
  for (Vertex v(0); v.index < map.size(); ++v.index) distances.push_back(map.distance(v));
  const std::vector<double> by_row = to_rows(rows, distances);
  ASSERT_EQ(by_row.size(), mesh.positions.size());
  Index mapped = 0;
  for (std::size_t r = 0; r < by_row.size(); ++r) {
    EXPECT_EQ(std::isnan(by_row[r]), rows.status[r] != Status::ok);
    if (rows.status[r] != Status::ok) continue;
    EXPECT_EQ(by_row[r], rows.distance[r]);
    ++mapped;
  }
  EXPECT_GT(mapped, 2);
  EXPECT_LT(mapped, static_cast<Index>(by_row.size()));  // the other pages are apart
  EXPECT_THROW(to_rows(rows, std::span(distances).first(1)), InvalidArgument);
}

TEST(Surface, TheClosestPointIsTheNearestOfManyInAllFaces) {
  const Mesh mesh = icosphere(4);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int parts = 12;
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3 query{normal(random), normal(random), normal(random)};
    const ClosestPoint found = surface.closest_point(query);
    EXPECT_NEAR(distance(found.position, query), found.distance, 1e-14);
    EXPECT_LT(distance(surface.position(found.point), found.position), 1e-14);
    double least = HUGE_VAL, longest = 0;
    for (const auto& [a, b, c] : mesh.faces) {
      longest = std::max({longest, distance(mesh.positions[a], mesh.positions[b])});
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j) {
          Vec3 p;
          for (int k = 0; k < 3; ++k)
            p[k] =
                (i * mesh.positions[a][k] + j * mesh.positions[b][k] + (parts - i - j) * mesh.positions[c][k]) / parts;
          least = std::min(least, distance(p, query));
        }
    }
    EXPECT_LE(found.distance, least + 1e-14);
    EXPECT_GE(found.distance, least - longest / parts);
  }
}

TEST(Surface, TheClosestPointOnAnEdgeIsOfTheFirstOfItsFacesHoweverRoundingFalls) {
  const Mesh mesh = icosphere(4);
  for (double scale : {1.0, 1.1, 3.0, 7.0, 0.3, 1.0000000001}) {
    std::vector<Vec3> positions = mesh.positions;
    for (Vec3& p : positions) p = {scale * p[0], scale * p[1], scale * p[2]};
    const auto surface = TriangleMeshSurface::build(positions, mesh.faces);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (int side = 0; side < 3; ++side) {
        const Index i = mesh.faces[f][side], j = mesh.faces[f][(side + 1) % 3];
        Vec3 p;
        for (std::size_t a = 0; a < 3; ++a) p[a] = 0.7 * positions[i][a] + 0.3 * positions[j][a];
        const auto found = std::get<FacePoint>(surface.closest_point(p).point);
        const auto beside = std::ranges::find_if(
            mesh.faces, [&](const Triangle& t) { return std::ranges::count(t, i) + std::ranges::count(t, j) == 2; });
        ASSERT_EQ(found.face, beside - mesh.faces.begin()) << scale;
        ASSERT_EQ(std::ranges::count(found.barycentric, 0.0), 1) << scale;
      }
  }
}

TEST(Surface, TheClosestPointOnASmallPartIsThatOfThePartAlone) {
  const Mesh mesh = icosphere(2);
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  for (const double scale : {1.0, 1e-12}) {  // the large part first
    const auto first = static_cast<Index>(positions.size());
    for (const Vec3& p : mesh.positions) positions.push_back({scale * p[0], scale * p[1], scale * p[2]});
    for (const auto& [a, b, c] : mesh.faces) faces.push_back({a + first, b + first, c + first});
  }
  const auto surface = TriangleMeshSurface::build(positions, faces);
  for (std::size_t f = mesh.faces.size(); f < faces.size(); ++f) {
    Vec3 p;
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = 0.5 * positions[faces[f][0]][a] + 0.3 * positions[faces[f][1]][a] + 0.2 * positions[faces[f][2]][a];
    ASSERT_EQ(std::get<FacePoint>(surface.closest_point(p).point).face, static_cast<Index>(f));
  }
}

TEST(Surface, ATangentPointOfACloudCarriesItsOffset) {
  std::vector<Vec3> points;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      points.push_back({0.1 * x + 0.01 * std::sin(7 * y), 0.1 * y + 0.01 * std::cos(5 * x), 2});
  const auto cloud = PointCloudSurface::build(points);
  const ClosestPoint found = cloud.closest_point({0.93, 1.02, 2.3});
  EXPECT_NEAR(found.distance, 0.3, 1e-12);
  const SurfaceSource source = cloud.source(found.point, Vec3{1, 0, 0});
  EXPECT_LT(distance(source.position, {0.93, 1.02, 2}), 1e-12);
  const double left = source.frame->normal[2] > 0 ? 1 : -1;
  const LogMap map = LogMapSolver(cloud.graph()).solve(source.source, {.frames = true});
  const RowLogMap rows = cloud.to_rows(map);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(rows.u[i], points[i][0] - 0.93, 1e-9);
    ASSERT_NEAR(rows.v[i], left * (points[i][1] - 1.02), 1e-9);
  }
  const Sample back = cloud.at(map, TangentPoint{Row(0), {0.33, 0.44, 5}});  // from far away, too
  EXPECT_NEAR(back.u, 0.33 - 0.93, 1e-9);
  EXPECT_NEAR(back.v, left * (0.44 - 1.02), 1e-9);
}

/// However often it is asked, and where several rows are equally near.
TEST(Surface, TheNearestRowIsTheFirstOfLeastDistance) {
  for (const double scale : {1.0, 0x1p-800, 0x1p900}) {
    std::vector<Vec3> points;
    for (int x = 0; x < 24; ++x)
      for (int y = 0; y < 24; ++y) points.push_back({scale * x, scale * y, x % 5 == 0 ? scale * 0.25 : 0});
    points.push_back(points[7]);
    points.push_back({NAN, 0, 0});
    const pointcloud::CloudOptions options{.drop_non_finite = true};
    const auto often = PointCloudSurface::build(points, {}, options);
    std::mt19937 random(3);
    std::uniform_int_distribution<int> half(-4, 52);
    for (int group = 0; group < 40; ++group) {
      const auto seldom = PointCloudSurface::build(points, {}, options);  // looks at all
      for (int k = 0; k < 2; ++k) {
        const Vec3 query{scale * 0.5 * half(random), scale * 0.5 * half(random), scale * 0.125 * (k % 3)};
        const Row row = often.nearest_row(query);
        ASSERT_EQ(row.index, seldom.nearest_row(query).index) << "group " << group << " at scale " << scale;
        for (const Vec3& p : points)
          ASSERT_FALSE(distance(p, query) < distance(points[row.index], query) * (1 - 1e-15));
      }
    }
  }
}

TEST(Surface, RowsThatACallerDidNotKeepAreRemovedAndSaidSo) {
  std::vector<Vec3> points;
  for (int x = 0; x < 15; ++x)
    for (int y = 0; y < 15; ++y) points.push_back({0.1 * x, 0.1 * y + 0.02 * (x % 2), 0});
  points[3] = {NAN, 0, 0};
  std::vector<Row> kept;
  for (Index i = 0; i < static_cast<Index>(points.size()); ++i)
    if (i % 7 != 3) kept.emplace_back(i);
  const auto cloud = PointCloudSurface::build(points, {}, {.rows = kept});
  std::vector<Vec3> remaining;
  for (const Row row : kept) remaining.push_back(points[row.index]);
  const auto alone = PointCloudSurface::build(remaining);
  const RowLogMap a = cloud.to_rows(LogMapSolver(cloud.graph()).solve(cloud.source(kept[9]).source));
  const RowLogMap b = alone.to_rows(LogMapSolver(alone.graph()).solve(alone.source(Row(9)).source));
  ASSERT_EQ(a.u.size(), points.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    EXPECT_EQ(a.u[kept[k].index], b.u[k]);
    EXPECT_EQ(a.v[kept[k].index], b.v[k]);
  }
  EXPECT_EQ(a.status[3], Status::removed);
  const std::vector<Vec3> mapped = mapped_positions(cloud);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_TRUE(i % 7 == 3 ? std::isnan(mapped[i][0]) : mapped[i] == points[i]) << i;
  try {
    cloud.source(Row(10));
    FAIL();
  } catch (const InvalidArgument& e) {
    EXPECT_EQ(e.fault(), "row_left_out");
  }
  EXPECT_THROW(PointCloudSurface::build(points, {}, {.rows = std::vector<Row>{Row(5), Row(4), Row(6)}}),
               InvalidArgument);
}

TEST(Surface, StaysValidWhenItIsMoved) {
  const Mesh mesh = icosphere(3);
  TriangleMeshSurface first = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const ClosestPoint before = first.closest_point({0, 0.3, 2});
  const LogMapSolver solver(first.graph());
  const TriangleMeshSurface second = std::move(first);
  EXPECT_EQ(second.closest_point({0, 0.3, 2}).position, before.position);
  EXPECT_EQ(second.to_rows(solver.solve(second.source(Row(4)).source)).status[0], Status::ok);
}

TEST(Surface, NamesWhatIsWrongWithAPoint) {
  Mesh mesh = icosphere(2);
  mesh.positions.push_back({5, 5, 5});  // in no face
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const auto fault = [&](const auto& call) -> std::string {
    try {
      call();
    } catch (const InvalidArgument& e) {
      return std::string(e.fault());
    }
    return "none";
  };
  EXPECT_EQ(fault([&] { surface.source(Row(mesh.vertices() - 1)); }), "row_unused");
  EXPECT_EQ(fault([&] { surface.source(Row(mesh.vertices())); }), "row_out_of_range");
  EXPECT_EQ(fault([&] { surface.source(Row(0), mesh.positions[0]); }), "axis_along_normal");
  EXPECT_THROW(surface.closest_point({NAN, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.nearest_row({0, 0, INFINITY}), InvalidArgument);
  EXPECT_NE(surface.nearest_row({5, 5, 4.9}), Row(mesh.vertices() - 1));  // it has no vertex
}

/// A vector so many degrees from a point of the unit sphere, of any length.
Vec3 tilted(const Vec3& p, double degrees, double scale = 1) {
  const double t = std::tan(degrees * std::numbers::pi / 180) / std::hypot(p[0], p[1]);
  return {scale * (p[0] - t * p[1]), scale * (p[1] + t * p[0]), scale * p[2]};
}

/// Of all rows those at which a surface takes an axis that is tilted from the normal of the unit sphere.
std::size_t taken(const Surface& sphere, double degrees, double scale = 1) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < sphere.positions().size(); ++r) {
    const Vec3& p = sphere.positions()[r];
    if (std::hypot(p[0], p[1]) < 0.1) continue;
    try {
      sphere.source(Row(static_cast<Index>(r)), tilted(p, degrees, scale));
      ++count;
    } catch (const InvalidArgument& e) {
      EXPECT_EQ(e.fault(), "axis_along_normal");
      EXPECT_NE(e.problem().find("degrees from the normal at row"), std::string::npos);
    }
  }
  return count;
}

TEST(Surface, TakesNoAxisThatTheNormalsErrorWouldTurn) {
  const Mesh ball = icosphere(8);
  const auto mesh = TriangleMeshSurface::build(ball.positions, ball.faces);
  const Cloud points = random_sphere(1500, 3);
  const auto estimated = pointcloud::PointCloudSurface::build(points.points),
             given = pointcloud::PointCloudSurface::build(points.points, points.normals);
  for (double scale : {1e-300, 1.0, 1e300})
    for (double degrees : {0.0, 0.5}) {
      EXPECT_EQ(taken(mesh, degrees, scale), 0U);
      EXPECT_EQ(taken(given, degrees, scale), 0U);
      EXPECT_LE(taken(estimated, degrees, scale), 3U);  // whose normals are farther off than 95 % of such
    }
  const std::size_t most = taken(estimated, 30);
  EXPECT_GT(most, 1400U);
  EXPECT_EQ(taken(given, 1.5), most);
  EXPECT_LT(taken(estimated, 2), most / 50);
  EXPECT_GT(taken(mesh, 2), 600U);
}

}  // namespace
}  // namespace ahm::test
