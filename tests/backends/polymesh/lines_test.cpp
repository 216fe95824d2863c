// Shortest paths and straight lines over the refinement of polygons, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/util/vec.hpp"
#include "backends/great_circles.hpp"

namespace ahm::test {
namespace {

using polymesh::PolygonMeshSurface;

PolygonMeshSurface surface_of(const Polygons& mesh) {
  return PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
}

TEST(LinesOnPolygons, AreStraightOnPlanes) {
  for (Polygons mesh : {voronoi_square(80), l_shapes(4), quad_grid(8), brick_wall(7)}) {
    tilt(mesh);
    const PolygonMeshSurface surface = surface_of(mesh);
    SCOPED_TRACE(mesh.vertices());
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

/// Of paths and of lines of length 2 on the unit sphere.
LineErrors sphere_errors(const Polygons& mesh) {
  const PolygonMeshSurface surface = surface_of(mesh);
  const ExactGeodesics geodesics(surface);
  LineErrors worst;
  for (Index k = 0; k < 12; ++k) {
    const Row from(mesh.vertices() / 13 * k + 5), to(mesh.vertices() / 17 * (k + 3) + 2);
    const Vec3 &a = mesh.positions[from.index], &b = mesh.positions[to.index];
    const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    if (angle < 0.3 || angle > 2.8) continue;
    const SurfacePoint ends[] = {from, to};
    const exact::GeodesicPath path = geodesics.path(ends);
    worst.length = std::max(worst.length, std::abs(path.length / angle - 1));
    const Vec3 normal = (1 / norm(cross(a, b))) * cross(a, b);
    for (const exact::MeshPoint& point : path.points)
      worst.off_circle = std::max(worst.off_circle, std::abs(dot(geodesics.position(point), normal)));
    const Vec3 along = cross(normal, a);
    const exact::TracedPath line = geodesics.trace(from, along, 2);
    worst.trace = std::max(worst.trace,
                           norm(geodesics.position(line.points.back()) - (std::cos(2.0) * a + std::sin(2.0) * along)));
  }
  return worst;
}

TEST(LinesOnPolygons, ConvergeToGreatCircles) {
  const LineErrors coarse = sphere_errors(dual_sphere(5)), fine = sphere_errors(dual_sphere(20));  // h / 4
  EXPECT_LT(coarse.length, 0.006);
  EXPECT_LT(coarse.off_circle, 0.06);  // a quarter of h
  EXPECT_LT(coarse.trace, 0.03);
  expect_convergence(coarse, fine);
}

}  // namespace
}  // namespace ahm::test
