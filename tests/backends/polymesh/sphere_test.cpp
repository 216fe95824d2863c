// The unit sphere as quads, hexagons and random cells against closed forms: maps, and lines over the refinement.
#include "ahm/conformance/closed_forms.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "backends/great_circles.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

using std::numbers::pi;

/// L2 error of the map from a vertex over the vertices within 0.85 pi.
double rms_error(const Polygons& mesh, Variant variant, Discretization discretization = Discretization::polygons) {
  const auto surface = build(mesh, discretization);
  const RowLogMap map =
      surface.to_rows(LogMapSolver(surface.graph()).solve(surface.source(Row(11)).source, {.variant = variant}));
  const Frame frame = *surface.graph().frame(surface.vertex(Row(11)).index);
  const SphereError error = sphere_error(mesh.positions, map.u, map.v, 11, frame.x, frame.y, 0.85 * pi);
  EXPECT_EQ(error.missing, 0);
  return error.rms;
}

TEST(PolygonSphere, ConvergesOnQuadsAndHexagons) {
  for (Variant variant : all_variants) {
    // At half the spacing the error is nearly half: measured orders are 0.9 and more.
    EXPECT_GT(std::log2(rms_error(cube_sphere(12), variant) / rms_error(cube_sphere(24), variant)), 0.7)
        << to_string(variant);
    EXPECT_GT(std::log2(rms_error(dual_sphere(7), variant) / rms_error(dual_sphere(14), variant)), 0.7)
        << to_string(variant);
  }
}

TEST(PolygonSphere, ConvergesOnRandomCellsWhenRefined) {
  const Polygons cells = voronoi_sphere(2400);
  EXPECT_TRUE(refined(cells).folded.empty());
  for (Variant variant : all_variants) {
    const double coarse = rms_error(voronoi_sphere(600), variant, Discretization::refined),
                 fine = rms_error(cells, variant, Discretization::refined);
    EXPECT_GT(std::log2(coarse / fine), 0.4) << to_string(variant) << ": " << coarse << ", " << fine;
    EXPECT_LT(fine, 0.1);
    EXPECT_LT(fine, rms_error(cells, variant));  // why the program refines
  }
}

TEST(PolygonSphere, HasItsDistancesFromInsideAFace) {
  const Polygons mesh = cube_sphere(24);
  const auto surface = build(mesh);
  const FacePoint middle{300, {0.25, 0.25, 0.25, 0.25}};
  const RowLogMap map = map_of(surface, middle);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double r = sphere_distance(normalized(surface.position(middle)), mesh.positions[i]);
    if (r < pi / 2) ASSERT_NEAR(map.distance[i], r, mean_edge(surface)) << "vertex " << i;
  }
}

TEST(PolygonSphere, IsMappedWhenStretched) {
  Polygons mesh = cube_sphere(20);
  for (Vec3& p : mesh.positions) p[2] *= 20;
  EXPECT_EQ(std::ranges::count(map_of(build(mesh), Row(0)).status, Status::ok), mesh.vertices());
}

TEST(LinesOnPolygons, AreStraightOnPlanes) {
  for (Polygons mesh : {voronoi_square(80), l_shapes(4), quad_grid(8), brick_wall(7)}) {
    tilt(mesh);
    SCOPED_TRACE(mesh.vertices());
    const auto surface = build(mesh, Discretization::automatic);
    const ExactGeodesics geodesics(surface);
    std::mt19937_64 random(4);
    const auto row = [&] { return Row(static_cast<Index>(random() % static_cast<std::size_t>(mesh.vertices()))); };
    for (int k = 0; k < 60; ++k) {
      const Row from = row(), to = row();
      const Vec3 &a = mesh.positions[from.index], &b = mesh.positions[to.index];
      const double apart = norm(b - a);
      if (!(apart > 0)) continue;
      const SurfacePoint ends[] = {from, to};
      for (const exact::GeodesicPath& path : {geodesics.path(ends), geodesics.locally_shortest_path(from, to)}) {
        EXPECT_NEAR(path.length, apart, 1e-12);
        for (const exact::MeshPoint& point : path.points)
          EXPECT_LT(norm(cross(geodesics.position(point) - a, b - a)) / apart, 1e-12);
      }
      const exact::TracedPath line = geodesics.trace(from, b - a, apart);
      EXPECT_NEAR(line.length, apart, 1e-12);
      EXPECT_LT(norm(geodesics.position(line.points.back()) - b), 1e-12);
    }
  }
}

LineErrors line_errors(const Polygons& mesh) {
  const auto surface = build(mesh, Discretization::automatic);
  const ExactGeodesics geodesics(surface);
  LineErrors worst;
  for (Index k = 0; k < 12; ++k) {
    const Row from(mesh.vertices() / 13 * k + 5), to(mesh.vertices() / 17 * (k + 3) + 2);
    const Vec3 &a = mesh.positions[from.index], &b = mesh.positions[to.index];
    if (sphere_distance(a, b) < 0.3 || sphere_distance(a, b) > 2.8) continue;
    const SurfacePoint ends[] = {from, to};
    const exact::GeodesicPath path = geodesics.path(ends);
    std::vector<Vec3> points;
    for (const exact::MeshPoint& point : path.points) points.push_back(geodesics.position(point));
    worst.add_path(a, b, path.length, points);
    const Vec3 along = cross(normalized(cross(a, b)), a);
    worst.add_trace(a, along, geodesics.position(geodesics.trace(from, along, 2).points.back()));
  }
  return worst;
}

TEST(LinesOnPolygons, ConvergeToGreatCircles) {
  const LineErrors coarse = line_errors(dual_sphere(5)), fine = line_errors(dual_sphere(20));  // h / 4
  EXPECT_LT(coarse.length, 0.006);
  EXPECT_LT(coarse.off_circle, 0.06);  // a quarter of h
  EXPECT_LT(coarse.trace, 0.03);
  expect_convergence(coarse, fine);
}

}  // namespace
}  // namespace ahm::test
