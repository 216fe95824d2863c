// The unit sphere as quads, hexagons and random cells, against the closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "polygons.hpp"

namespace ahm::test {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// L2 error over the vertices within 0.85 pi.
double sphere_error(const Polygons& mesh, const LogMap& map, const Frame& frame, Index source) {
  const Vec3& p = mesh.positions[source];
  double sum = 0, count = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const Vec3& q = mesh.positions[i];
    const double c = std::clamp(dot(p, q), -1.0, 1.0), r = std::acos(c);
    if (r > 0.85 * std::numbers::pi || i == source) continue;
    const Vec3 t{q[0] - c * p[0], q[1] - c * p[1], q[2] - c * p[2]};
    const double scale = r / std::sqrt(dot(t, t));
    sum += std::pow(map.coordinates(Vertex(i))[0] - scale * dot(t, frame.x), 2) +
           std::pow(map.coordinates(Vertex(i))[1] - scale * dot(t, frame.y), 2);
    count += 1;
  }
  return std::sqrt(sum / count);
}

double polygon_error(const Polygons& mesh, Variant variant) {
  const auto surface = mesh.graph();
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(11)).source, {.variant = variant});
  return sphere_error(mesh, map, *surface.graph().frame(11), 11);
}

double refined_error(const Polygons& mesh, Variant variant) {
  const auto refined = polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
  EXPECT_TRUE(refined.folded.empty());
  const auto surface = trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(11)).source, {.variant = variant});
  return sphere_error(mesh, map, *surface.graph().frame(11), 11);
}

TEST(PolygonSphere, ConvergesOnQuadsAndHexagons) {
  for (Variant variant : {Variant::adaptive, Variant::localized}) {
    // Halving h must at least nearly halve the error: measured 0.9 and more.
    const double quads[] = {polygon_error(cube_sphere(12), variant), polygon_error(cube_sphere(24), variant)};
    EXPECT_GT(std::log2(quads[0] / quads[1]), 0.7) << to_string(variant) << ": " << quads[0] << ", " << quads[1];
    const double hexagons[] = {polygon_error(dual_sphere(7), variant), polygon_error(dual_sphere(14), variant)};
    EXPECT_GT(std::log2(hexagons[0] / hexagons[1]), 0.7) << to_string(variant);
  }
}

TEST(PolygonSphere, ConvergesOnRandomCellsWhenRefined) {
  for (Variant variant : {Variant::adaptive, Variant::localized}) {
    const double coarse = refined_error(voronoi_sphere(600), variant),
                 fine = refined_error(voronoi_sphere(2400), variant);
    EXPECT_GT(std::log2(coarse / fine), 0.4) << to_string(variant) << ": " << coarse << ", " << fine;
    EXPECT_LT(fine, 0.1);
    EXPECT_LT(fine, polygon_error(voronoi_sphere(2400), variant));  // why the program refines
  }
}

TEST(PolygonSphere, StartsInsideAFaceToo) {
  const Polygons mesh = cube_sphere(24);
  const auto surface = mesh.graph();
  const Index face = 300;
  const std::vector<double> weights(4, 0.25);
  const PlacedSource middle = surface.source(FacePoint{face, weights});
  const Frame frame = *middle.frame;
  const double length = std::sqrt(dot(frame.origin, frame.origin));
  const Vec3 p{frame.origin[0] / length, frame.origin[1] / length, frame.origin[2] / length};
  const LogMap map = LogMapSolver(surface.graph()).solve(middle.source);
  const double h = surface.graph().mean_edge_length() * surface.graph().length_unit();
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double r = std::acos(std::clamp(dot(p, mesh.positions[i]), -1.0, 1.0));
    if (r < std::numbers::pi / 2) ASSERT_NEAR(map.distance(Vertex(i)), r, h) << "vertex " << i;
  }
}

TEST(PolygonSphere, StretchedCellsStayPositiveAndMapped) {
  Polygons mesh = cube_sphere(20);
  for (Vec3& p : mesh.positions) p[2] *= 20;
  const auto surface = mesh.graph();
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
  EXPECT_EQ(map.count(Status::ok), surface.graph().size());
}

}  // namespace
}  // namespace ahm::test
