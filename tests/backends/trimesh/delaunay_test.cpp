// The intrinsic triangulation: Delaunay, the same surface, and findable.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "ahm/conformance/vectors.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

using trimesh::TriangleMeshSurface;

double total_mass(const TriangleMeshSurface& surface) {
  double sum = 0;
  for (Index i = 0; i < surface.graph().size(); ++i) sum += surface.graph().mass(i);
  return sum * surface.graph().length_unit() * surface.graph().length_unit();
}

FacePoint random_point(const Mesh& mesh, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  FacePoint p{static_cast<Index>(random() % mesh.faces.size()), {uniform(random), uniform(random), 0}};
  if (p.barycentric[0] + p.barycentric[1] > 1)
    for (int s : {0, 1}) p.barycentric[s] = 1 - p.barycentric[s];
  p.barycentric[2] = 1 - p.barycentric[0] - p.barycentric[1];
  return p;
}

/// Jittered sphere with vertices moved along the surface until many edges are not Delaunay.
Mesh rough_sphere(Index parts) {
  Mesh mesh = icosphere(parts);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.35 / parts, 0.35 / parts);
  for (Vec3& p : mesh.positions) {
    for (double& x : p) x += shift(random);
    const double r = std::sqrt(dot(p, p));
    for (double& x : p) x /= r;
  }
  return mesh;
}

TEST(Flips, ConserveTheArea) {
  for (const Mesh& mesh : {sliver_square(800), holed_square(30), rough_sphere(12), moebius_mesh(60, 5)}) {
    const auto flipped = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const auto plain = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
    EXPECT_GT(flipped.details().flips, 10);
    EXPECT_EQ(flipped.details().edges, plain.details().edges);
    EXPECT_NEAR(total_mass(flipped), total_mass(plain), 1e-12 * total_mass(plain));
  }
}

TEST(Flips, LeaveOnlyWeightsOfDelaunayEdges) {
  for (const Mesh& mesh : {sliver_square(800), rough_sphere(12), moebius_mesh(60, 5)}) {
    // Unclamped, interior edges have weight >= 0 up to rounding; boundary edges may not.
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.clamp_weights = false});
    std::map<std::pair<Index, Index>, int> faces_at;  // flips leave the edges of the boundary where they are
    for (const Triangle& t : mesh.faces)
      for (int s = 0; s < 3; ++s) ++faces_at[std::minmax(t[s], t[(s + 1) % 3])];
    for (Index i = 0; i < surface.graph().size(); ++i) {
      const Star star = surface.graph().star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const auto at = faces_at.find(std::minmax(i, star.neighbors[e]));
        const bool on_boundary = at != faces_at.end() && at->second == 1;
        EXPECT_TRUE(star.weights[e] >= -1e-9 || on_boundary) << i << " to " << star.neighbors[e];
      }
    }
  }
}

TEST(Flips, KeepFlatVerticesFlat) {
  // The logs of a flat graph tell the angles: each star must close, that is, neighbours lie where the plane has them.
  const Mesh mesh = sliver_square(800);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (Index i = 0; i < surface.graph().size(); ++i) {
    const Star star = surface.graph().star(i);
    for (std::size_t e = 1; e < star.degree(); ++e) {
      const auto p = star.log(e - 1), q = star.log(e);
      const auto &a = mesh.plane[i], &b = mesh.plane[star.neighbors[e - 1]], &c = mesh.plane[star.neighbors[e]];
      const double unit = surface.graph().length_unit();
      EXPECT_NEAR(unit * std::hypot(p[0] - q[0], p[1] - q[1]), std::hypot(b[0] - c[0], b[1] - c[1]), 1e-11)
          << "vertex " << i;
      EXPECT_NEAR(unit * std::hypot(p[0], p[1]), std::hypot(b[0] - a[0], b[1] - a[1]), 1e-12);
    }
  }
}

TEST(Flips, AreFewAndTheirHistoryIsShallow) {
  for (Index side : {40, 80, 160}) {
    const Mesh mesh = holed_square(side);
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    EXPECT_LT(surface.details().flips, 1.5 * static_cast<double>(mesh.faces.size()));
    std::mt19937_64 random(1);
    double depth = 0;
    for (int trial = 0; trial < 2000; ++trial) depth += surface.locate(random_point(mesh, random)).depth / 2000.0;
    EXPECT_LT(depth, 4) << side;
  }
}

TEST(History, FindsEveryPointOfThePlane) {
  std::mt19937_64 random(2);
  for (const Mesh& mesh :
       {sliver_square(500), sliver_square(4000, 5), holed_square(40), holed_square(40, 2, 1e-4), maze(10)}) {
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    EXPECT_GT(surface.details().flips, 0);
    double worst = 0;
    for (int trial = 0; trial < 20000; ++trial) {
      const FacePoint point = random_point(mesh, random);
      const auto found = surface.locate(point);
      const auto wanted = plane_point(mesh, point);
      double p[2] = {0, 0};
      for (int s = 0; s < 3; ++s) {
        ASSERT_GE(found.barycentric[s], 0);
        for (int a = 0; a < 2; ++a)
          p[a] += found.barycentric[s] * mesh.plane[surface.mesh().input_of_vertex()[found.vertices[s]]][a];
      }
      worst = std::max(worst, std::hypot(p[0] - wanted[0], p[1] - wanted[1]));
    }
    EXPECT_LT(worst, 1e-11);
    RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
  }
}

TEST(History, FindsCornersAndPointsOnEdges) {
  const Mesh mesh = sliver_square(1500, 3);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (Index f = 0; f < static_cast<Index>(mesh.faces.size()); ++f)
    for (int s = 0; s < 3; ++s) {
      FacePoint corner{f, {0, 0, 0}}, middle{f, {0.5, 0.5, 0.5}};
      corner.barycentric[s] = 1;
      middle.barycentric[s] = 0;
      for (const FacePoint& point : {corner, middle}) {
        const auto found = surface.locate(point);
        const auto wanted = plane_point(mesh, point);
        double p[2] = {0, 0};
        for (int k = 0; k < 3; ++k)
          for (int a = 0; a < 2; ++a) p[a] += found.barycentric[k] * mesh.plane[found.vertices[k]][a];
        ASSERT_NEAR(p[0], wanted[0], 1e-12);
        ASSERT_NEAR(p[1], wanted[1], 1e-12);
      }
    }
}

}  // namespace
}  // namespace ahm::test
