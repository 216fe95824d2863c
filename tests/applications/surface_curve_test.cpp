// Curves drawn on surfaces, and the maps from them: coordinates, distances, spread, quality and the nearest sample.
#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

constexpr Index side = 16;  ///< vertices of a side

/// The unit square in z = 0 as quadrilaterals, with inner vertices moved a little.
Polygons unit_square() {
  Polygons mesh = quad_grid(side - 1);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Index x = i % side, y = i / side;
    const double shift = x > 0 && y > 0 && x + 1 < side && y + 1 < side ? 0.2 : 0;
    mesh.positions[i] = {(x + shift * std::sin(7.0 * y)) / (side - 1), (y + shift * std::cos(5.0 * x)) / (side - 1), 0};
  }
  return mesh;
}

/// Calls visit(surface) for the square as triangles, as quadrilaterals, as refined quadrilaterals and as points.
void for_each_square(const std::function<void(const Surface&)>& visit) {
  const Polygons mesh = unit_square();
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.faces(); ++f) {
    const auto q = mesh.face(f);
    triangles.insert(triangles.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
  }
  visit(trimesh::TriangleMeshSurface::build(mesh.positions, triangles));
  visit(polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                            {.discretization = polymesh::Discretization::polygons}));
  visit(polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners));
  visit(pointcloud::PointCloudSurface::build(mesh.positions));
}

/// Calls visit(surface) for a mesh and for its vertices as points.
void for_mesh_and_cloud(const Mesh& mesh, const std::function<void(const Surface&)>& visit) {
  visit(mesh_surface(mesh));
  visit(pointcloud::PointCloudSurface::build(mesh.positions));
}

/// A circle parallel to the plane z = 0.
std::vector<CurvePoint> circle(const Vec3& center, double radius, int count) {
  std::vector<CurvePoint> points;
  for (int k = 0; k < count; ++k) {
    const double a = 2 * pi * k / count;
    points.emplace_back(center + radius * Vec3{std::cos(a), std::sin(a), 0});
  }
  return points;
}

/// A curve with its map by heat.
struct SolvedCurve {
  SolvedCurve(const Surface& surface, std::span<const CurvePoint> points, const StrokeOptions& options = {})
      : curve(draw_curve(surface, points, options)),
        map(LogMapSolver(surface.graph()).solve(curve.source)),
        rows(rows_from_curve(surface, map, curve)) {}
  SurfaceCurve curve;
  LogMap map;
  RowLogMap rows;
};

TEST(SurfaceCurve, HasArclengthAndSignedDistanceOfAStraightLineAboveThePlane) {
  for_each_square([](const Surface& surface) {
    const Vec3 from{0.2, 0.3, 0.01}, to{0.8, 0.5, 0.01};
    const double length = std::hypot(0.6, 0.2), c = 0.6 / length, s = 0.2 / length;
    const CurvePoint points[] = {from, Vec3{0.5, 0.4, 0.01}, to};
    const SolvedCurve solved(surface, points);
    const SurfaceCurve& curve = solved.curve;
    EXPECT_NEAR(curve.length, length, 1e-12);
    EXPECT_NEAR(curve.gap, 0.01, 1e-12);
    EXPECT_LE(curve.jump, 0.6 * edge_length(surface.graph()));  // half of the edges there
    ASSERT_TRUE(curve.first);
    EXPECT_NEAR(curve.first->x[0], c, 1e-12);
    const double left = curve.first->normal[2];  // 1 or -1
    for (std::size_t r = 0; r < solved.rows.u.size(); ++r) {
      const Vec3 p = surface.positions()[r] - from;
      ASSERT_NEAR(solved.rows.u[r], c * p[0] + s * p[1], 1e-9);
      ASSERT_NEAR(solved.rows.v[r], left * (c * p[1] - s * p[0]), 1e-9);
    }
  });
}

TEST(SurfaceCurve, PassesThroughRows) {
  for_each_square([](const Surface& surface) {
    const CurvePoint points[] = {SurfacePoint(Row(5 * side + 3)), Vec3{0.7, 0.8, 0}, SurfacePoint(Row(9 * side + 12))};
    const SurfaceCurve curve = draw_curve(surface, points);
    EXPECT_EQ(curve.points.front(), surface.positions()[5 * side + 3]);
    EXPECT_EQ(curve.points.back(), surface.positions()[9 * side + 12]);
    EXPECT_LT(curve.gap, 1e-12);
  });
}

TEST(SurfaceCurve, IsAGeodesicPathOnFaces) {
  const auto mesh = mesh_surface(icosphere(10));
  const CurvePoint ends[] = {mesh.position(Row(3)), mesh.position(Row(200))};
  const SurfaceCurve curve = draw_curve(mesh, ends);
  const double edge = edge_length(mesh.graph());
  const ExactGeodesics geodesics(mesh);
  EXPECT_NEAR(curve.length, geodesics.path(std::array<SurfacePoint, 2>{Row(3), Row(200)}).length, 0.02 * edge);
  EXPECT_LT(curve.gap, 1e-12);
  EXPECT_LT(curve.jump, 0.6 * edge);
  EXPECT_GE(static_cast<double>(curve.samples.size()), curve.length / curve.jump - 1e-9);
  // The samples are the sources of an exact map, which has u = 0 .. length along the curve.
  const LogMap map = geodesics.log_map(curve.samples).map;
  for (const auto& [row, u] : {std::pair{3, 0.0}, {200, curve.length}}) {
    EXPECT_NEAR(map.coordinates(mesh.vertex(Row(row)))[0], u, 1e-9);
    EXPECT_NEAR(map.coordinates(mesh.vertex(Row(row)))[1], 0, 1e-9);
  }
}

TEST(SurfaceCurve, ThroughNearPointsHasTheLengthOfTheirPaths) {
  const auto surface = mesh_surface(split_icosphere(162));
  const ExactGeodesics geodesics(surface);
  std::vector<SurfacePoint> stops;
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.3 * k;
    stops.push_back(surface.closest_point({std::cos(angle), std::sin(angle), 0.2 * std::sin(angle)}).point);
  }
  const SurfaceCurve curve = draw_curve(surface, std::vector<CurvePoint>(stops.begin(), stops.end()));
  double length = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) length += geodesics.path(std::span(stops).subspan(k, 2)).length;
  EXPECT_NEAR(curve.length, length, 1e-11);
  EXPECT_LT(curve.gap, 1e-12);
  for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
    EXPECT_LT(surface.closest_point(0.5 * (curve.points[k] + curve.points[k + 1])).distance, 1e-12) << k;
}

// A curve that is straight when the surface is unrolled has the coordinates of the plane, although its chords in space cut corners.
TEST(SurfaceCurve, IsStraightAcrossFolds) {
  const Mesh mesh = folded_strip(20);
  const auto surface = mesh_surface(mesh);
  const Index first = 20 * 3 + 5, last = 20 * 12 + 17;
  const CurvePoint ends[] = {Row(first), Row(last)};
  const SurfaceCurve curve = draw_curve(surface, ends);
  const Vec2 along = mesh.plane[last] - mesh.plane[first];
  const double length = ahm::length(along), c = along[0] / length, s = along[1] / length;
  const auto exact = [&](Index r) {
    const Vec2 p = mesh.plane[r] - mesh.plane[first];
    return Vec2{c * p[0] + s * p[1], c * p[1] - s * p[0]};
  };
  EXPECT_NEAR(curve.length, length, 1e-12);
  for (const bool is_exact : {false, true})
    for (Variant variant : all_variants) {
      const LogMap map = is_exact ? ExactGeodesics(surface).log_map(curve.samples).map
                                  : LogMapSolver(surface.graph(), {.variant = variant}).solve(curve.source);
      const RowLogMap rows = rows_from_curve(surface, map, curve);
      const double left = (rows.v[0] > 0) == (exact(0)[1] > 0) ? 1 : -1;
      for (Index r = 0; r < mesh.vertices(); ++r) {
        const auto [u, v] = exact(r);
        ASSERT_NEAR(rows.u[r], u, 1e-9) << r;
        ASSERT_NEAR(rows.v[r], left * v, 1e-9) << r;
        const double d = std::hypot(std::max({0.0, -u, u - length}), v);
        ASSERT_NEAR(rows.distance[r], d, is_exact ? 1e-9 : 0.01 * d + 1e-3) << r;
      }
    }
}

TEST(SurfaceCurve, HasTheSameMapNextToAnotherComponentOfAnyScale) {
  const CurvePoint points[] = {Row(3), Row(800), Row(1400)};
  const auto solved = [&](const Mesh& mesh) {
    const auto surface = mesh_surface(mesh);
    const SurfaceCurve curve = draw_curve(surface, points);
    const double radius = 0.7, reach = map_radius_of_curve(curve, radius);
    return rows_from_curve(surface, LogMapSolver(surface.graph()).solve(curve.source, {.radius = reach}), curve,
                           radius);
  };
  const RowLogMap alone = solved(torus(2000));
  for (const double scale : {0.02, 30.0}) {
    Mesh other = icosphere(20);
    for (Vec3& p : other.positions) p = scale * p;
    const RowLogMap both = solved(joined(torus(2000), other, {5 + 2 * scale, 0, 0}));
    for (std::size_t r = 0; r < alone.u.size(); ++r) {
      ASSERT_EQ(both.status[r], alone.status[r]) << r;
      if (alone.status[r] != Status::ok) continue;
      ASSERT_NEAR(both.u[r], alone.u[r], 1e-9) << r;
      ASSERT_NEAR(both.v[r], alone.v[r], 1e-9) << r;
      ASSERT_NEAR(both.distance[r], alone.distance[r], 1e-9) << r;
    }
  }
}

TEST(SurfaceCurve, OfManyPointsIsSampledNoFiner) {
  const auto surface = mesh_surface(flat_square(20));
  std::vector<CurvePoint> points;
  for (int k = 0; k <= 2000; ++k) points.emplace_back(Vec3{0.1 + 0.8 * k / 2000, 0.2 + 0.5 * k / 2000, 0});
  const SolvedCurve few(surface, std::array{points.front(), points.back()}), many(surface, points);
  EXPECT_NEAR(many.curve.length, few.curve.length, 1e-9);
  EXPECT_LT(static_cast<double>(many.curve.samples.size()), 1.5 * static_cast<double>(few.curve.samples.size()));
  for (std::size_t i = 0; i < few.map.coordinates().size(); ++i)
    ASSERT_NEAR(many.map.coordinates()[i], few.map.coordinates()[i], 1e-9);
}

TEST(SurfaceCurve, IsAGeodesicPathOnClouds) {
  const Cloud ball = even_sphere(4000);
  const auto cloud = pointcloud::PointCloudSurface::build(ball.points);
  const CurvePoint ends[] = {ball.points[3], ball.points[2900]};
  const SurfaceCurve curve = draw_curve(cloud, ends);
  const double edge = edge_length(cloud.graph());
  EXPECT_EQ(curve.straight, 0);
  EXPECT_NEAR(curve.length, std::acos(dot(ball.points[3], ball.points[2900])), 0.2 * edge);
  EXPECT_LT(curve.gap, 0.2 * edge);  // of a straight line it would be the radius
  EXPECT_LT(curve.jump, edge);
}

TEST(SurfaceCurve, CountsStraightLinesThatAreNoPaths) {
  const Mesh square = flat_square(12);
  const Index n = square.vertices();
  const auto row = [](Index r) { return CurvePoint(SurfacePoint(Row(r))); };
  const auto expect_straight = [](const Surface& surface, std::vector<CurvePoint> points, Index count,
                                  const std::string& reason) {
    const SurfaceCurve curve = draw_curve(surface, points);
    EXPECT_EQ(curve.straight, count);
    EXPECT_EQ(curve.straight_reason.empty(), count == 0);
    EXPECT_NE(curve.straight_reason.find(reason), std::string::npos) << curve.straight_reason;
  };
  expect_straight(mesh_surface(square), {row(13), row(n - 14)}, 0, "");
  // One line within each of two squares, and one between them.
  expect_straight(mesh_surface(joined(square, square, {2, 0, 0})), {row(13), row(n - 14), row(n + 13), row(2 * n - 14)},
                  1, "does not connect");
  expect_straight(pointcloud::PointCloudSurface::build(unit_square().positions), {row(17), row(200)}, 0, "");
  // A strip of quadrilaterals, one of which is twisted.
  const std::vector<Vec3> bent{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0},
                               {3, 0, 0}, {3, 1, 0}, {4, 0, 0},   {4, 1, 0}, {5, 0, 0}, {5, 1, 0}};
  const std::vector<Index> corners{0, 1, 2, 3, 1, 4, 5, 2, 4, 6, 7, 5, 6, 8, 9, 7, 8, 10, 11, 9};
  const std::vector<Offset> begin{0, 4, 8, 12, 16, 20};
  expect_straight(
      polymesh::PolygonMeshSurface::build(bent, begin, corners, {.discretization = polymesh::Discretization::polygons}),
      {row(0), row(11)}, 1, "");
}

// Where geodesic paths from both sides of a curve meet, the coordinates are those of neither, but distances are accurate.
TEST(SurfaceCurve, HasTheDistancesOfTheSurface) {
  for (const Mesh& mesh : {icosphere(8), torus(2000)}) {
    const auto surface = mesh_surface(mesh);
    const CurvePoint points[] = {Row(100), Row(120), Row(400)};
    for (const bool closed : {false, true}) {
      const SolvedCurve solved(surface, points, {.closed = closed});
      const LogMap exact = ExactGeodesics(surface).log_map(solved.curve.samples).map;
      for (Index i = 0; i < mesh.vertices(); ++i) {
        const double d = exact.distance(surface.vertex(Row(i)));
        ASSERT_NEAR(solved.rows.distance[i], d, 0.5 * edge_length(surface.graph()) + 0.02 * d) << i << " " << closed;
      }
    }
  }
}

// v is biased near a bend, the distance is not.
TEST(SurfaceCurve, HasTheDistancesFromACircle) {
  const Mesh mesh = flat_square(61);
  for_mesh_and_cloud(mesh, [&](const Surface& surface) {
    const double edge = edge_length(surface.graph()), radius = 10 * edge;
    const Vec3 middle = surface.positions()[mesh.vertices() / 2];
    const SolvedCurve solved(surface, circle(middle, radius, 48), {.closed = true});
    double sum = 0;
    Index count = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const Vec3 p = surface.positions()[i] - middle;
      if (std::max(std::abs(p[0]), std::abs(p[1])) > 2 * radius) continue;
      sum += std::abs(solved.rows.distance[i] - std::abs(std::hypot(p[0], p[1]) - radius));
      ++count;
    }
    EXPECT_LT(sum / count, (surface.faces().size() > 0 ? 0.03 : 0.1) * edge);
  });
}

TEST(SurfaceCurve, IsRefusedWithAFault) {
  const auto band = mesh_surface(moebius_mesh(80, 6));
  const auto fault = [&](const std::vector<CurvePoint>& points, bool closed) -> std::string {
    try {
      draw_curve(band, points, {.closed = closed});
    } catch (const InvalidArgument& e) {
      return std::string(e.fault());
    }
    return "none";
  };
  const std::vector<CurvePoint> round = circle({0, 0, 0}, 1, 40);
  EXPECT_EQ(fault(round, false), "none");
  EXPECT_EQ(fault(round, true), "curve_one_sided");
  EXPECT_EQ(fault({round[0], round[0]}, false), "curve_too_short");
  EXPECT_EQ(fault({round[0], round[1], round[0]}, false), "curve_turns_back");
  EXPECT_EQ(fault({Vec3{0, 0, 0}, Vec3{1e7, 0, 0}}, false), "curve_too_long");
  EXPECT_EQ(fault({}, false), "curve_too_short");
}

std::vector<double> row_quality(const Surface& surface, const LogMap& map, const RowLogMap& rows) {
  return to_rows(rows, map_quality(surface.graph(), map));
}

TEST(CurveQuality, IsThatOfThePlaneForAStraightLine) {
  for_mesh_and_cloud(flat_square(30), [](const Surface& surface) {
    const CurvePoint ends[] = {Vec3{0.2, 0.33, 0}, Vec3{0.8, 0.47, 0}};
    const SolvedCurve solved(surface, ends);
    for (const double quality : row_quality(surface, solved.map, solved.rows)) EXPECT_GT(quality, 0.9);
    for (const double spread : solved.rows.spread) EXPECT_LT(spread, 1e-6);
  });
}

TEST(CurveQuality, IsComputedWithTheNearestSample) {
  for_mesh_and_cloud(flat_square(20), [](const Surface& surface) {
    const SolvedCurve solved(surface, circle({0.5, 0.5, 0}, 0.3, 90), {.closed = true});
    ASSERT_EQ(solved.map.nearest().size(), solved.map.status().size());
    std::vector<Vec3> samples;
    for (const ExactSource& sample : solved.curve.samples) samples.push_back(surface.position(sample.point));
    for (Index r = 0; r < std::ssize(surface.positions()); ++r) {
      const Vec3 p = surface.positions()[r];
      double least = INFINITY;
      for (const Vec3& sample : samples) least = std::min(least, distance(sample, p));
      const Index nearest = solved.map.nearest()[surface.rows().vertex(Row(r))->index];
      EXPECT_LT(distance(samples[nearest], p), least + 0.1 * edge_length(surface.graph()));
    }
  });
}

TEST(CurveQuality, IsLowAtTheCenterOfACircleAndWhereUJumps) {
  for_mesh_and_cloud(flat_square(60), [](const Surface& surface) {
    const double edge = edge_length(surface.graph());
    const SolvedCurve solved(surface, circle({0.5, 0.5, 0}, 0.3, 90), {.closed = true});
    const auto check = [&](const LogMap& map, const RowLogMap& rows) {
      const std::vector<double> quality = row_quality(surface, map, rows);
      int near_curve = 0, high = 0;
      for (std::size_t r = 0; r < quality.size(); ++r) {
        const Vec3& p = surface.positions()[r];
        const double x = p[0] - 0.5, y = p[1] - 0.5, from_middle = std::hypot(x, y);
        if (from_middle < edge || (x > 0.1 && x < 0.4 && std::abs(y) < 0.3 * edge))
          EXPECT_LT(quality[r], reliable_quality) << p[0] << ' ' << p[1];
        if (std::abs(from_middle - 0.3) > 0.1 || (x > 0 && std::abs(y) < 0.1)) continue;
        ++near_curve;
        high += quality[r] > reliable_quality;
        EXPECT_NEAR(rows.distance[r], std::abs(from_middle - 0.3), edge);
      }
      EXPECT_GT(high, 0.8 * near_curve);
    };
    check(solved.map, solved.rows);
    if (surface.faces().size() == 0) return;
    const LogMap exact = ExactGeodesics(surface).log_map(solved.curve.samples).map;
    check(exact, rows_from_curve(surface, exact, solved.curve));
  });
}

// A row is right if its error is less than a tenth of the distance, or than an edge.
TEST(CurveQuality, SeparatesRightRowsFromWrongOnes) {
  const Mesh mesh = torus(4000);
  const auto exact_surface = mesh_surface(mesh);
  const CurvePoint ends[] = {Row(0), Row(mesh.vertices() / 7)};
  const SurfaceCurve drawn = draw_curve(exact_surface, ends);
  const RowLogMap exact = exact_surface.to_rows(ExactGeodesics(exact_surface).log_map(drawn.samples).map);
  for_mesh_and_cloud(mesh, [&](const Surface& surface) {
    const SolvedCurve solved(surface, std::vector<CurvePoint>(drawn.points.begin(), drawn.points.end()));
    const std::vector<double> quality = row_quality(surface, solved.map, solved.rows);
    const double sign = dot(solved.curve.first->normal, drawn.first->normal) > 0 ? 1 : -1;
    int high = 0, right = 0, right_and_high = 0;
    for (std::size_t r = 0; r < quality.size(); ++r) {
      const double error = std::hypot(solved.rows.u[r] - exact.u[r], solved.rows.v[r] - sign * exact.v[r]);
      const bool is_right = error < std::max(0.1 * exact.distance[r], edge_length(surface.graph()));
      right += is_right;
      high += quality[r] > reliable_quality;
      right_and_high += is_right && quality[r] > reliable_quality;
    }
    EXPECT_LT(right, 0.9 * static_cast<double>(quality.size()));  // otherwise there is nothing to separate
    EXPECT_GT(right_and_high, 0.95 * high);
    EXPECT_GT(right_and_high, 0.75 * right);
  });
}

}  // namespace
}  // namespace ahm::test
