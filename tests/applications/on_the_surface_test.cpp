// Tool paths, strokes and centers lie on the faces with all of their length.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ahm/applications/coverage.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

using trimesh::TriangleMeshSurface;

Vec3 middle(const Vec3& a, const Vec3& b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}; }

TriangleMeshSurface sphere(Index n) {
  const Mesh mesh = split_icosphere(n);
  return TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

/// Points and the straight lines between them.
void expect_on(const Surface& surface, const CoveragePath& path, double rounding) {
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const CoveragePoint& p = path.points[k];
    ASSERT_LT(surface.closest_point(p.position).distance, rounding) << k;
    if (k == 0 || path.points[k - 1].piece != p.piece) {
      EXPECT_EQ(p.arclength, 0);
      EXPECT_FALSE(p.between);
      continue;
    }
    const CoveragePoint& last = path.points[k - 1];
    ASSERT_LT(surface.closest_point(middle(last.position, p.position)).distance, rounding) << k;
    ASSERT_NEAR(p.arclength - last.arclength, distance(last.position, p.position), rounding);
  }
}

TEST(OnTheSurface, CoverPathsAreShortestBetweenPointsOfTheirPattern) {
  const TriangleMeshSurface surface = sphere(640);
  const ExactGeodesics geodesics(surface);
  const InverseMap inverse = inverse_map(surface, geodesics.log_map(Row{5}, {}, {.frames = true, .progress = {}}));
  for (const double step : {0.05, 0.5}) {  // a third of an edge, three of them
    const CoverageOptions options{.radius = 1.4, .spacing = 0.3, .step = step};
    const CoveragePath path = coverage_path(surface, inverse, options), chords = coverage_path(inverse, options);
    expect_on(surface, path, 1e-12);
    const auto of_pattern = std::ranges::count(path.points, false, &CoveragePoint::between);
    EXPECT_EQ(static_cast<std::size_t>(of_pattern), chords.points.size());
    EXPECT_GT(path.points.size(), chords.points.size());
    EXPECT_EQ(path.pieces, chords.pieces);
    const CoveragePoint* last = nullptr;
    for (const CoveragePoint& p : path.points) {
      EXPECT_NEAR(dot(p.heading, p.normal), 0, 1e-12);
      EXPECT_NEAR(dot(p.heading, p.heading), 1, 1e-12);
      if (p.between) continue;
      if (last != nullptr && last->piece == p.piece) {
        const SurfacePoint ends[] = {surface.closest_point(last->position).point,
                                     surface.closest_point(p.position).point};
        EXPECT_NEAR(p.arclength - last->arclength, geodesics.path(ends).length, 1e-11);
      }
      last = &p;
    }
  }
}

TEST(OnTheSurface, CoverPathsOfPolygonsThatAreNotFlatLieOnTheTrianglesOfTheirPaths) {
  Polygons mesh = cube_sphere(7);
  for (Vec3& p : mesh.positions) p[2] += 0.2 * p[0] * p[1];
  const auto surface = polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
  const ExactGeodesics geodesics(surface);
  const FlatTriangles& flat = geodesics.triangles();
  std::vector<std::array<Index, 3>> faces;
  for (Index f = 0; f < flat.surface.face_count(); ++f)
    faces.push_back(
        {flat.surface.record(3 * f).tail, flat.surface.record(3 * f + 1).tail, flat.surface.record(3 * f + 2).tail});
  const auto triangles = TriangleMeshSurface::build(flat.positions, faces);
  const InverseMap inverse = inverse_map(surface, geodesics.log_map(Row{5}, {}, {.frames = true, .progress = {}}));
  const CoveragePath path = coverage_path(surface, inverse, {.radius = 1, .spacing = 0.2});
  EXPECT_GT(path.points.size(), 100u);
  EXPECT_EQ(path.straight_reason, "");
  expect_on(triangles, path, 1e-12);
}

TEST(OnTheSurface, CoverPathsOfPlanesAreTheSameAsWithStraightLines) {
  const Mesh mesh = flat_square(20);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const LogMap map = ExactGeodesics(surface).log_map(Row{190}, {}, {.frames = true, .progress = {}});
  const InverseMap inverse = inverse_map(surface, map);
  for (const auto pattern : {CoveragePattern::raster, CoveragePattern::spiral}) {
    const CoverageOptions options{.radius = 0.4, .spacing = 0.07, .pattern = pattern, .angle = 0.3};
    const CoveragePath path = coverage_path(surface, inverse, options), chords = coverage_path(inverse, options);
    ASSERT_EQ(path.points.size(), chords.points.size());
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const CoveragePoint &a = path.points[k], &b = chords.points[k];
      EXPECT_EQ(a.position, b.position);
      EXPECT_EQ(a.heading, b.heading);
      EXPECT_EQ(a.piece, b.piece);
      EXPECT_EQ(a.arclength, b.arclength);
      EXPECT_FALSE(a.between);
    }
  }
}

/// A square of side 2 about the origin without a slit of one cell's width, |y| < 0.8.
Mesh slit_square() {
  constexpr Index cells = 41;
  Mesh mesh;
  for (Index y = 0; y <= cells; ++y)
    for (Index x = 0; x <= cells; ++x) mesh.positions.push_back({2.0 * x / cells - 1, 2.0 * y / cells - 1, 0});
  for (Index y = 0; y < cells; ++y)
    for (Index x = 0; x < cells; ++x) {
      const Index a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      if (x == cells / 2 && std::abs(y - cells / 2) < 17) continue;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

TEST(OnTheSurface, CoverPathsDoNotFlyOverSlits) {
  const Mesh mesh = slit_square();
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Row source = surface.nearest_row({-0.4, 0, 0});
  // By heat, whose coordinates go on beyond the slit.
  const LogMap map = LogMapSolver(surface.graph()).solve(Source::at_vertex(surface.vertex(source)), {.frames = true});
  const InverseMap inverse = inverse_map(surface, map, {.min_quality = 0});
  const CoverageOptions options{.radius = 1.2, .spacing = 0.15, .step = 0.12};
  const CoveragePath path = coverage_path(surface, inverse, options), chords = coverage_path(inverse, options);
  expect_on(surface, path, 1e-12);
  EXPECT_GT(path.pieces, chords.pieces);
  Index around = 0;
  for (const CoveragePoint& p : path.points) around += p.between;
  EXPECT_GT(around, 0);  // about the ends of the slit
}

TEST(OnTheSurface, StrokesThroughPointsNearbyHaveTheLengthOfTheirPaths) {
  const TriangleMeshSurface surface = sphere(162);
  const ExactGeodesics geodesics(surface);
  std::vector<CurvePoint> given;
  std::vector<SurfacePoint> stops;
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.3 * k, z = 0.2 * std::sin(angle);
    const ClosestPoint on = surface.closest_point({std::cos(angle), std::sin(angle), z});
    given.push_back(on.point);
    stops.push_back(on.point);
  }
  const SurfaceCurve curve = draw_curve(surface, given);
  double length = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) length += geodesics.path(std::span(stops).subspan(k, 2)).length;
  EXPECT_NEAR(curve.length, length, 1e-11);
  EXPECT_LT(curve.gap, 1e-12);
  for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
    EXPECT_LT(surface.closest_point(middle(curve.points[k], curve.points[k + 1])).distance, 1e-12) << k;
}

TEST(OnTheSurface, CentersLieWhereTheirOffsetLeads) {
  const TriangleMeshSurface surface = sphere(640);
  const ExactGeodesics geodesics(surface);
  const auto& flat = geodesics.triangles();
  for (Index first : {0, 17, 300}) {
    const std::array towns{Vertex(first), Vertex(first + 41), Vertex(first + 160)};
    const Center center = karcher_mean(geodesics, towns);
    ASSERT_GT(std::hypot(center.offset[0], center.offset[1]), 1e-3);
    const ClosestPoint there = surface.closest_point(center_position(surface, center));
    EXPECT_LT(there.distance, 1e-13);
    exact::ExactOptions options;
    options.targets = {geodesics.point(there.point)};
    const exact::ExactMap map = exact::exact_map(flat.surface, flat.surface.vertex_point(center.vertex), options);
    for (std::size_t a : {0, 1}) EXPECT_NEAR(flat.length_unit * map.target_coordinates(0)[a], center.offset[a], 1e-12);
  }
}

TEST(OnTheSurface, CentersWhoseOffsetLeadsOutLieOnTheBoundary) {
  const Mesh mesh = flat_square(5, 0);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const auto corner = std::min_element(mesh.positions.begin(), mesh.positions.end());
  const Vertex vertex = surface.vertex(Row(static_cast<Index>(corner - mesh.positions.begin())));
  const Frame frame = surface.graph().frame(vertex.index).value();
  const auto position = [&](const Vec3& offset) {
    return center_position(surface, {.vertex = vertex, .offset = {dot(offset, frame.x), dot(offset, frame.y)}});
  };
  const Vec3 c = *corner;
  const auto at = [&](double x, double y) { return Vec3{c[0] + x, c[1] + y, c[2]}; };
  EXPECT_LT(distance(position({0.1, 0.05, 0}), at(0.1, 0.05)), 1e-15);
  EXPECT_LT(distance(position({0.1, -0.05, 0}), at(0.1, 0)), 1e-15);
  EXPECT_LT(distance(position({-0.05, 0.1, 0}), at(0, 0.1)), 1e-15);
  EXPECT_LT(distance(position({-0.1, -0.05, 0}), at(0, 0)), 1e-15);
  EXPECT_LT(distance(position({-1e-17, 1e-18, 0}), at(0, 0)), 1e-15);
  EXPECT_THROW(center_position(surface, {.vertex = Vertex(99), .offset = {0, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
