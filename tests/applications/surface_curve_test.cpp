// Curves drawn on surfaces: on flat ones, arclength and signed distance exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

constexpr Index side = 16;

/// The unit square in z = 0, points of its inside moved a little.
std::vector<Vec3> square_points() {
  std::vector<Vec3> points;
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x) {
      const bool inside = x > 0 && y > 0 && x + 1 < side && y + 1 < side;
      points.push_back({(x + (inside ? 0.2 * std::sin(7.0 * y) : 0)) / (side - 1),
                        (y + (inside ? 0.2 * std::cos(5.0 * x) : 0)) / (side - 1), 0});
    }
  return points;
}

/// Calls visit(surface) for the square as triangles, as quadrilaterals and as points.
void for_each_square(const std::function<void(const Surface&)>& visit) {
  const std::vector<Vec3> points = square_points();
  std::vector<Triangle> triangles;
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
  for (Index y = 0; y + 1 < side; ++y)
    for (Index x = 0; x + 1 < side; ++x) {
      const Index i = y * side + x;
      triangles.insert(triangles.end(), {{i, i + 1, i + side + 1}, {i, i + side + 1, i + side}});
      corners.insert(corners.end(), {i, i + 1, i + side + 1, i + side});
      begin.push_back(static_cast<Offset>(corners.size()));
    }
  visit(trimesh::TriangleMeshSurface::build(points, triangles));
  visit(polymesh::PolygonMeshSurface::build(points, begin, corners,
                                            {.discretization = polymesh::Discretization::polygons}));
  visit(polymesh::PolygonMeshSurface::build(points, begin, corners));
  visit(pointcloud::PointCloudSurface::build(points));
}

TEST(SurfaceCurve, AStraightLineInSpaceGivesArclengthAndSignedDistanceBelow) {
  for_each_square([](const Surface& surface) {
    const Vec3 from{0.2, 0.3, 0.01}, to{0.8, 0.5, 0.01};
    const double length = std::hypot(0.6, 0.2), c = 0.6 / length, s = 0.2 / length;
    const CurvePoint given[] = {from, Vec3{0.5, 0.4, 0.01}, to};
    const SurfaceCurve curve = draw_curve(surface, given);
    EXPECT_NEAR(curve.length, length, 1e-12);
    EXPECT_NEAR(curve.gap, 0.01, 1e-12);
    const TangentGraph& graph = surface.graph();
    EXPECT_LE(curve.jump, 0.6 * graph.mean_edge_length() * graph.length_unit());  // half of the edges there
    ASSERT_TRUE(curve.first);
    EXPECT_NEAR(curve.first->x[0], c, 1e-12);
    const double left = curve.first->normal[2];  // 1 or -1
    const RowLogMap map = surface.to_rows(LogMapSolver(graph).solve(curve.source));
    for (std::size_t r = 0; r < map.u.size(); ++r) {
      const double x = surface.positions()[r][0] - from[0], y = surface.positions()[r][1] - from[1];
      ASSERT_NEAR(map.u[r], c * x + s * y, 1e-9);
      ASSERT_NEAR(map.v[r], left * (c * y - s * x), 1e-9);
    }
  });
}

TEST(SurfaceCurve, GoesThroughRowsThatAreGiven) {
  for_each_square([](const Surface& surface) {
    const CurvePoint given[] = {SurfacePoint(Row(5 * side + 3)), Vec3{0.7, 0.8, 0}, SurfacePoint(Row(9 * side + 12))};
    const SurfaceCurve curve = draw_curve(surface, given);
    EXPECT_EQ(curve.points.front(), surface.positions()[5 * side + 3]);
    EXPECT_EQ(curve.points.back(), surface.positions()[9 * side + 12]);
    EXPECT_LT(curve.gap, 1e-12);
  });
}

TEST(SurfaceCurve, FollowsTheFacesBetweenFewPoints) {
  // From pole to pole a straight line passes through the middle of the sphere; the curve goes around.
  const Mesh ball = icosphere(10);
  const auto mesh = trimesh::TriangleMeshSurface::build(ball.positions, ball.faces);
  const Vec3 a = mesh.position(Row(3)), b = mesh.position(Row(200));
  const CurvePoint given[] = {a, b};
  const SurfaceCurve curve = draw_curve(mesh, given);
  const double edge = mesh.graph().mean_edge_length() * mesh.graph().length_unit();
  EXPECT_NEAR(curve.length, ExactGeodesics(mesh).path(std::array<SurfacePoint, 2>{Row(3), Row(200)}).length,
              0.02 * edge);
  EXPECT_LT(curve.gap, 1e-12);
  EXPECT_LT(curve.jump, 0.6 * edge);
  EXPECT_GE(static_cast<double>(curve.samples.size()), curve.length / curve.jump - 1e-9);
  // The samples are the sources of an exact map: u = 0 .. length along the curve.
  const auto [map, labels] = ExactGeodesics(mesh).log_map(curve.samples);
  EXPECT_NEAR(map.coordinates(mesh.vertex(Row(3)))[0], 0, 1e-9);
  EXPECT_NEAR(map.coordinates(mesh.vertex(Row(200)))[0], curve.length, 1e-9);
  for (Index r : {3, 200}) EXPECT_NEAR(map.coordinates(mesh.vertex(Row(r)))[1], 0, 1e-9);
}

// A curve that is straight when the surface is unrolled has the coordinates of the plane, although its chords in space cut corners.
TEST(SurfaceCurve, GoesStraightAcrossFolds) {
  const Mesh mesh = folded_strip(20);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Index first = 20 * 3 + 5, last = 20 * 12 + 17;
  const CurvePoint given[] = {Row(first), Row(last)};
  const SurfaceCurve curve = draw_curve(surface, given);
  const auto from_first = [&](Index r) {
    return Vec2{mesh.plane[r][0] - mesh.plane[first][0], mesh.plane[r][1] - mesh.plane[first][1]};
  };
  const Vec2 along = from_first(last);
  const double length = std::hypot(along[0], along[1]), c = along[0] / length, s = along[1] / length;
  EXPECT_NEAR(curve.length, length, 1e-12);
  for (const bool is_exact : {false, true})
    for (Variant variant : all_variants) {
      const LogMap map = is_exact ? ExactGeodesics(surface).log_map(curve.samples).map
                                  : LogMapSolver(surface.graph(), {.variant = variant}).solve(curve.source);
      const RowLogMap rows = rows_from_curve(surface, map, curve);
      const Vec2 corner = from_first(0);
      const double left = (rows.v[0] > 0) == (c * corner[1] - s * corner[0] > 0) ? 1 : -1;
      for (Index r = 0; r < mesh.vertices(); ++r) {
        const Vec2 p = from_first(r);
        const double u = c * p[0] + s * p[1], v = c * p[1] - s * p[0];
        ASSERT_NEAR(rows.u[r], u, 1e-9) << r;
        ASSERT_NEAR(rows.v[r], left * v, 1e-9) << r;
        const double d = std::hypot(std::max({0.0, -u, u - length}), v);
        ASSERT_NEAR(rows.distance[r], d, is_exact ? 1e-9 : 0.01 * d + 1e-3) << r;
      }
    }
}

// Whatever else is in the file, and however large its edges.
TEST(SurfaceCurve, HasTheSameMapBesideAnotherPart) {
  const Mesh own = torus(2000);
  const CurvePoint given[] = {Row(3), Row(800), Row(1400)};
  const auto solved = [&](const Mesh& mesh) {
    const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const SurfaceCurve curve = draw_curve(surface, given);
    const double radius = 0.7, reach = map_radius_of_curve(curve, radius);
    const LogMap map = LogMapSolver(surface.graph()).solve(curve.source, {.radius = reach});
    return rows_from_curve(surface, map, curve, radius);
  };
  const RowLogMap alone = solved(own);
  for (const double scale : {0.02, 30.0}) {
    Mesh other = icosphere(20);
    for (Vec3& p : other.positions)
      for (double& x : p) x *= scale;
    const RowLogMap beside = solved(joined(own, other, {5 + 2 * scale, 0, 0}));
    for (std::size_t r = 0; r < alone.u.size(); ++r) {
      ASSERT_EQ(beside.status[r], alone.status[r]) << r;
      if (alone.status[r] != Status::ok) continue;
      ASSERT_NEAR(beside.u[r], alone.u[r], 1e-9) << r;
      ASSERT_NEAR(beside.v[r], alone.v[r], 1e-9) << r;
      ASSERT_NEAR(beside.distance[r], alone.distance[r], 1e-9) << r;
    }
  }
}

// As a scanner or a drawing program gives it.
TEST(SurfaceCurve, OfManyPointsIsCutNoFiner) {
  const Mesh mesh = flat_square(20);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  std::vector<CurvePoint> few{Vec3{0.1, 0.2, 0}, Vec3{0.9, 0.7, 0}}, many;
  for (int k = 0; k <= 2000; ++k) many.emplace_back(Vec3{0.1 + 0.8 * k / 2000, 0.2 + 0.5 * k / 2000, 0});
  const SurfaceCurve by_few = draw_curve(surface, few), by_many = draw_curve(surface, many);
  EXPECT_NEAR(by_many.length, by_few.length, 1e-9);
  EXPECT_LT(static_cast<double>(by_many.samples.size()), 1.5 * static_cast<double>(by_few.samples.size()));
  const RowLogMap rows = surface.to_rows(LogMapSolver(surface.graph()).solve(by_many.source)),
                  expected = surface.to_rows(LogMapSolver(surface.graph()).solve(by_few.source));
  for (std::size_t r = 0; r < rows.u.size(); ++r) {
    ASSERT_NEAR(rows.u[r], expected.u[r], 1e-9);
    ASSERT_NEAR(rows.v[r], expected.v[r], 1e-9);
  }
}

TEST(SurfaceCurve, FollowsACloudBetweenFewPoints) {
  const Cloud ball = even_sphere(4000);
  const auto cloud = pointcloud::PointCloudSurface::build(ball.points);
  const Index far = 2900;
  const CurvePoint given[] = {ball.points[3], ball.points[far]};
  const SurfaceCurve curve = draw_curve(cloud, given);
  const double edge = cloud.graph().mean_edge_length() * cloud.graph().length_unit();
  EXPECT_EQ(curve.straight, 0);
  EXPECT_NEAR(curve.length, std::acos(dot(ball.points[3], ball.points[far])), 0.2 * edge);
  EXPECT_LT(curve.gap, 0.2 * edge);  // in space it would be the radius
  EXPECT_LT(curve.jump, edge);
}

TEST(SurfaceCurve, TellsWhichLinesAreNoPaths) {
  // Two squares beside each other: a line within each, and one between them.
  const Mesh square = flat_square(12);
  std::vector<Vec3> points = square.positions;
  std::vector<Triangle> faces = square.faces;
  for (const Vec3& p : square.positions) points.push_back({p[0] + 2, p[1], p[2]});
  for (const Triangle& f : square.faces)
    faces.push_back({f[0] + square.vertices(), f[1] + square.vertices(), f[2] + square.vertices()});
  const auto at = [&](Index row) { return CurvePoint(SurfacePoint(Row(row))); };
  const std::vector<CurvePoint> across{at(13), at(square.vertices() - 14), at(square.vertices() + 13),
                                       at(2 * square.vertices() - 14)};
  const SurfaceCurve torn = draw_curve(trimesh::TriangleMeshSurface::build(points, faces), across);
  EXPECT_EQ(torn.straight, 1);
  EXPECT_EQ(torn.straight_reason, "the surface does not connect their ends");
  const SurfaceCurve whole = draw_curve(trimesh::TriangleMeshSurface::build(square.positions, square.faces),
                                        std::vector<CurvePoint>{across[0], across[1]});
  EXPECT_EQ(whole.straight, 0);
  EXPECT_EQ(whole.straight_reason, "");
  // A cloud has no faces: there, straight lines are the rule.
  EXPECT_EQ(draw_curve(pointcloud::PointCloudSurface::build(square_points()), std::vector{at(17), at(200)}).straight,
            0);
  // A square of quadrilaterals one of which is twisted.
  std::vector<Vec3> bent{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0},
                         {3, 0, 0}, {3, 1, 0}, {4, 0, 0},   {4, 1, 0}, {5, 0, 0}, {5, 1, 0}};
  const std::vector<Index> corners{0, 1, 2, 3, 1, 4, 5, 2, 4, 6, 7, 5, 6, 8, 9, 7, 8, 10, 11, 9};
  const std::vector<Offset> begin{0, 4, 8, 12, 16, 20};
  const SurfaceCurve twisted = draw_curve(
      polymesh::PolygonMeshSurface::build(bent, begin, corners, {.discretization = polymesh::Discretization::polygons}),
      std::vector{at(0), at(11)});
  EXPECT_EQ(twisted.straight, 1);
  EXPECT_NE(twisted.straight_reason, "");
}

// Where ways meet from both sides of a curve, coordinates are those of none.
TEST(SurfaceCurve, ItsRowsAreAsFarAsTheSurfaceIsLong) {
  for (const Mesh& mesh : {icosphere(8), torus(2000)}) {
    const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const LogMapSolver solver(surface.graph());
    const double edge = surface.graph().mean_edge_length() * surface.graph().length_unit();
    for (const bool closed : {false, true}) {
      const CurvePoint given[] = {Row(100), Row(120), Row(400)};
      const SurfaceCurve curve = draw_curve(surface, given, {.closed = closed});
      const RowLogMap rows = rows_from_curve(surface, solver.solve(curve.source), curve);
      const LogMap exact = ExactGeodesics(surface).log_map(curve.samples).map;
      for (Index i = 0; i < mesh.vertices(); ++i) {
        const double d = exact.distance(surface.vertex(Row(i)));
        ASSERT_NEAR(rows.distance[i], d, 0.5 * edge + 0.02 * d) << i << " " << closed;
      }
    }
  }
}

// v is biased beside a bend, the distance is not.
TEST(SurfaceCurve, ItsRowsKnowTheirDistanceFromACircle) {
  const Mesh mesh = flat_square(61);
  const auto check = [&](const Surface& surface, double most) {
    const double edge = surface.graph().mean_edge_length() * surface.graph().length_unit(), radius = 10 * edge;
    const Vec3 middle = surface.positions()[mesh.vertices() / 2];
    std::vector<CurvePoint> given;
    for (int k = 0; k < 48; ++k) {
      const double a = 2 * std::numbers::pi * k / 48;
      given.emplace_back(Vec3{middle[0] + radius * std::cos(a), middle[1] + radius * std::sin(a), 0});
    }
    const SurfaceCurve curve = draw_curve(surface, given, {.closed = true});
    const RowLogMap rows = rows_from_curve(surface, LogMapSolver(surface.graph()).solve(curve.source), curve);
    double sum = 0;
    Index count = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const Vec3& p = surface.positions()[i];
      const double from_middle = std::hypot(p[0] - middle[0], p[1] - middle[1]);
      if (std::max(std::abs(p[0] - middle[0]), std::abs(p[1] - middle[1])) > 2 * radius) continue;
      sum += std::abs(rows.distance[i] - std::abs(from_middle - radius));
      ++count;
    }
    EXPECT_LT(sum / count, most * edge);
  };
  check(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces), 0.03);
  check(pointcloud::PointCloudSurface::build(mesh.positions), 0.1);
}

TEST(SurfaceCurve, SaysWhatIsWrongWithACurve) {
  const Mesh band = moebius_mesh(80, 6);
  const auto surface = trimesh::TriangleMeshSurface::build(band.positions, band.faces);
  const auto fault = [&](const std::vector<CurvePoint>& given, bool closed) -> std::string {
    try {
      draw_curve(surface, given, {.closed = closed});
    } catch (const InvalidArgument& e) {
      return std::string(e.fault());
    }
    return "none";
  };
  std::vector<CurvePoint> round;
  for (int k = 0; k < 40; ++k) {
    const double angle = 2 * std::numbers::pi * k / 40;
    round.push_back(Vec3{std::cos(angle), std::sin(angle), 0});
  }
  EXPECT_EQ(fault(round, false), "none");
  EXPECT_EQ(fault(round, true), "curve_one_sided");
  EXPECT_EQ(fault({round[0], round[0]}, false), "curve_too_short");
  EXPECT_EQ(fault({round[0], round[1], round[0]}, false), "curve_turns_back");
  EXPECT_EQ(fault({Vec3{0, 0, 0}, Vec3{1e7, 0, 0}}, false), "curve_too_long");
  EXPECT_EQ(fault({}, false), "curve_too_short");
}

}  // namespace
}  // namespace ahm::test
