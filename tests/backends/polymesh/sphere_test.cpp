// The unit sphere as quads, hexagons and random cells, against the closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

/// L2 error over the vertices within 0.85 pi.
double rms_error(const Polygons& mesh, const LogMap& map, const Frame& frame, Index source) {
  std::vector<double> u, v;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    u.push_back(map.coordinates(Vertex(i))[0]);
    v.push_back(map.coordinates(Vertex(i))[1]);
  }
  const SphereError error = sphere_error(mesh.positions, u, v, source, frame.x, frame.y, 0.85 * std::numbers::pi);
  EXPECT_EQ(error.missing, 0);
  return error.rms;
}

double polygon_error(const Polygons& mesh, Variant variant) {
  const auto surface = build(mesh);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(11)).source, {.variant = variant});
  return rms_error(mesh, map, *surface.graph().frame(11), 11);
}

double refined_error(const Polygons& mesh, Variant variant) {
  const auto refined = polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
  EXPECT_TRUE(refined.folded.empty());
  const auto surface = trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(11)).source, {.variant = variant});
  return rms_error(mesh, map, *surface.graph().frame(11), 11);
}

TEST(PolygonSphere, ConvergesOnQuadsAndHexagons) {
  for (Variant variant : all_variants) {
    // Halving h must at least nearly halve the error: measured 0.9 and more.
    const double quads[] = {polygon_error(cube_sphere(12), variant), polygon_error(cube_sphere(24), variant)};
    EXPECT_GT(std::log2(quads[0] / quads[1]), 0.7) << to_string(variant) << ": " << quads[0] << ", " << quads[1];
    const double hexagons[] = {polygon_error(dual_sphere(7), variant), polygon_error(dual_sphere(14), variant)};
    EXPECT_GT(std::log2(hexagons[0] / hexagons[1]), 0.7) << to_string(variant);
  }
}

TEST(PolygonSphere, ConvergesOnRandomCellsWhenRefined) {
  for (Variant variant : all_variants) {
    const double coarse = refined_error(voronoi_sphere(600), variant),
                 fine = refined_error(voronoi_sphere(2400), variant);
    EXPECT_GT(std::log2(coarse / fine), 0.4) << to_string(variant) << ": " << coarse << ", " << fine;
    EXPECT_LT(fine, 0.1);
    EXPECT_LT(fine, polygon_error(voronoi_sphere(2400), variant));  // why the program refines
  }
}

TEST(PolygonSphere, StartsInsideAFaceToo) {
  const Polygons mesh = cube_sphere(24);
  const auto surface = build(mesh);
  const Index face = 300;
  const std::vector<double> weights(4, 0.25);
  const SurfaceSource middle = surface.source(FacePoint{face, weights});
  const Vec3 p = unit(middle.frame->origin);
  const LogMap map = LogMapSolver(surface.graph()).solve(middle.source);
  const double h = surface.graph().mean_edge_length() * surface.graph().length_unit();
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double r = sphere_distance(p, mesh.positions[i]);
    if (r < std::numbers::pi / 2) ASSERT_NEAR(map.distance(Vertex(i)), r, h) << "vertex " << i;
  }
}

TEST(PolygonSphere, StretchedCellsStayPositiveAndMapped) {
  Polygons mesh = cube_sphere(20);
  for (Vec3& p : mesh.positions) p[2] *= 20;
  const auto surface = build(mesh);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
  EXPECT_EQ(map.count(Status::ok), surface.graph().size());
}

}  // namespace
}  // namespace ahm::test
