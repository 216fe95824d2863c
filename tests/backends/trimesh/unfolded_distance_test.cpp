// Distances of coarse and sharp meshes, unfolded, against exact ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

Mesh stretched(Mesh mesh, double factor) {
  for (Vec3& p : mesh.positions) p[0] *= factor;
  return mesh;
}

/// The 95th percentile of the relative errors, from `points` together.
double error_from(const SolvedMesh& mesh, std::initializer_list<SurfacePoint> points) {
  std::vector<double> errors;
  for (const SurfacePoint& point : points) {
    const LogMap exact = exact_log_map(mesh.surface, point),
                 heat = mesh.solver.solve(mesh.surface.source(point).source);
    for (Index i = 0; i < exact.size(); ++i)
      if (const double d = exact.distance(Vertex(i)); d > 0)
        errors.push_back(std::abs(heat.distance(Vertex(i)) / d - 1));
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() * 95 / 100];
}

/// A prism of `sides` sides, its edges longer than it is wide, so that sides of triangles go around it.
Mesh prism(Index sides, Index rings) {
  Mesh mesh;
  for (Index i = 0; i <= rings; ++i)
    for (Index k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.positions.push_back({0.1 * std::cos(angle), 0.1 * std::sin(angle), 1.0 * i / rings + 0.03 * std::sin(i)});
    }
  for (Index i = 0; i < rings; ++i)
    for (Index k = 0; k < sides; ++k) {
      const Index a = i * sides + k, b = i * sides + (k + 1) % sides;
      mesh.faces.push_back({a, b, b + sides});
      mesh.faces.push_back({a, b + sides, a + sides});
    }
  for (Index k = 1; k + 1 < sides; ++k) {
    mesh.faces.push_back({0, k + 1, k});
    mesh.faces.push_back({rings * sides, rings * sides + k, rings * sides + k + 1});
  }
  return mesh;
}

TEST(UnfoldedDistance, IsWithinAThousandthOrSoOnCoarseSurfaces) {
  EXPECT_LT(error_from(SolvedMesh(icosphere(8)), {Row(0), Row(300), FacePoint{77, {0.2, 0.3, 0.5}}}), 0.0009);
  EXPECT_LT(error_from(SolvedMesh(stretched(icosphere(12), 20)), {Row(0), Row(700), FacePoint{500, {0.2, 0.3, 0.5}}}),
            0.0012);
}

// Twenty vertices, each a corner.
TEST(UnfoldedDistance, IsWithinAHundredthOrSoOnAPrism) {
  EXPECT_LT(error_from(SolvedMesh(prism(5, 3)),
                       {Row(0), Row(9), FacePoint{12, {0.2, 0.3, 0.5}}, EdgePoint{Row(0), Row(1), 0.3}}),
            0.015);
}

// Both crossed by the midpoints, or neither.
TEST(UnfoldedDistance, IsOfSecondOrder) {
  for (const auto& [coarse, stretch] : {std::pair{16, 1.0}, {8, 2.0}}) {
    const auto error = [factor = stretch](int side) {
      return error_from(SolvedMesh(stretched(icosphere(side), factor)), {Row(0), Row(200)});
    };
    EXPECT_LT(error(2 * coarse), error(coarse) / 3) << stretch;
  }
}

TEST(UnfoldedDistance, OfACoarsePartIsThatOfThePartAlone) {
  const Mesh part = stretched(icosphere(8), 3);
  const SolvedMesh alone(part), beside(joined(part, icosphere(34), {0, 30, 0}));
  ASSERT_GT(beside.surface.graph().size(), 10000);
  const LogMapSolver marching(beside.surface.graph(), {.strategy = Strategy::march});
  const Vec3 axis{0.3, 0.5, 0.7};
  for (const SurfacePoint& point : {SurfacePoint(Row(17)), SurfacePoint(FacePoint{300, {0.2, 0.3, 0.5}})}) {
    const Source source = beside.surface.source(point, axis).source;
    const LogMap expected = alone.solver.solve(alone.surface.source(point, axis).source);
    const LogMap map = beside.solver.solve(source), marched = marching.solve(source);
    Wavefront front(beside.surface.graph());
    front.add(source);
    front.run();
    for (Index i = 0; i < part.vertices(); ++i) {
      const Vertex here = beside.surface.vertex(Row(i));
      const double distance = expected.distance(alone.surface.vertex(Row(i)));
      EXPECT_NEAR(map.distance(here), distance, 1e-12);
      EXPECT_EQ(marched.distance(here), map.distance(here));
      EXPECT_EQ(front.distance(here), map.distance(here));
    }
  }
}

// Large faces beside small ones: a straight way may cross a side whose ends are both beyond the radius.
TEST(UnfoldedDistance, IsTheSameWithinARadius) {
  Mesh flat;
  flat.positions = {{0, 0, 0}, {10, 0, 0}, {5, -8, 0}, {5, 3, 0}, {6, 3.5, 0}, {4, 3.5, 0}};
  flat.faces = {{0, 2, 1}, {0, 1, 3}, {1, 4, 3}, {0, 3, 5}, {3, 4, 5}};
  for (const Mesh& mesh : {flat, prism(5, 3), stretched(prism(4, 6), 7)}) {
    const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
    for (Strategy strategy : {Strategy::global, Strategy::march}) {
      const LogMapSolver solver(surface.graph(), {.strategy = strategy});
      for (const std::vector<double>& weights : {std::vector{.475, .05, .475}, {.4, .1, .5}, {.1, .1, .8}})
        for (Index face : {0, 3}) {
          const Source source = surface.source(FacePoint{face, weights}).source;
          const LogMap whole = solver.solve(source);
          const double longest = std::ranges::max(whole.distances());
          for (double radius : {0.3 * longest, 0.6 * longest, 0.9 * longest}) {
            const LogMap part = solver.solve(source, {.radius = radius});
            for (Index i = 0; i < whole.size(); ++i) {
              const double distance = whole.distance(Vertex(i));
              ASSERT_EQ(part.status(Vertex(i)) == Status::ok, distance <= radius) << i << ", radius " << radius;
              if (distance <= radius) ASSERT_NEAR(part.distance(Vertex(i)), distance, 1e-12 * longest) << i;
            }
          }
        }
    }
  }
}

}  // namespace
}  // namespace ahm::test
