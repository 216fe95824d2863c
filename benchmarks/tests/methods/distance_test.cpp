// HM and the exact distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "flat_maps.hpp"
#include "methods/method.hpp"

namespace ahm::test {
namespace {

using methods::Method;
using methods::Result;
using trimesh::TriangleMesh;
using trimesh::TriangleMeshSurface;

/// A diffusion time at which the error due to the layout of edges is small. At t_coef = 1 that part does not decrease with
/// h and hides the order.
constexpr double long_time = 16;

Method on_graph(const TriangleMeshSurface& surface) { return methods::heat_distance(surface.graph(), long_time); }
Method on_faces(const TriangleMeshSurface& surface) { return methods::heat_distance(surface.mesh(), long_time); }

/// Root mean square error of distances from the center of a square, away from its border.
template <class Make>
double square_error(Index side, const Make& make) {
  const Mesh mesh = flat_square(side);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Index source = nearest(mesh, {0.5, 0.5});
  const Result result = make(surface)->solve(source);
  double sum = 0;
  Index count = 0;
  for (Index i = 0; i < mesh.vertices(); ++i)
    if (plane_distance(mesh, source, i) < 0.4) {
      sum += std::pow(result.distance[i] - plane_distance(mesh, source, i), 2);
      ++count;
    }
  return std::sqrt(sum / count);
}

TEST(HeatDistance, ConvergesWithFirstOrderInThePlane) {
  for (const auto& make : {on_graph, on_faces}) {
    const double coarse = square_error(41, make), fine = square_error(81, make);
    EXPECT_GT(std::log2(coarse / fine), 0.8) << coarse << ", " << fine;
  }
}

/// Root mean square error of distances on the unit sphere.
template <class Make>
double sphere_error(Index parts, const Make& make) {
  const Mesh mesh = icosphere(parts);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const Index source = parts * parts / 3;
  const Result result = make(surface)->solve(source);
  double sum = 0;
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double exact = std::acos(std::clamp(dot(mesh.positions[source], mesh.positions[i]), -1.0, 1.0));
    sum += std::pow(result.distance[i] - exact, 2);
  }
  return std::sqrt(sum / mesh.vertices());
}

TEST(HeatDistance, ConvergesWithFirstOrderOnTheSphere) {
  for (const auto& make : {on_graph, on_faces}) {
    const double coarse = sphere_error(16, make), fine = sphere_error(48, make);
    EXPECT_GT(std::log2(coarse / fine) / std::log2(3.0), 0.8) << coarse << ", " << fine;
  }
}

TEST(MeshHeatDistance, KeepsToItsComponent) {
  const Mesh square = flat_square(21);
  Mesh two = square;
  for (Vec3 p : square.positions) two.positions.push_back({p[0] + 3, p[1], p[2]});
  for (const auto& [a, b, c] : square.faces)
    two.faces.push_back({a + square.vertices(), b + square.vertices(), c + square.vertices()});
  const auto one_mesh = TriangleMesh::from_positions(square.positions, square.faces);
  const auto two_mesh = TriangleMesh::from_positions(two.positions, two.faces);
  const Result one = methods::heat_distance(one_mesh)->solve(5), both = methods::heat_distance(two_mesh)->solve(5);
  for (Index i = 0; i < square.vertices(); ++i) {
    EXPECT_NEAR(both.distance[i], one.distance[i], 1e-9);
    EXPECT_TRUE(std::isnan(both.distance[i + square.vertices()]));
  }
}

TEST(MeshHeatDistance, RefusesFacesWithoutArea) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> faces{{0, 1, 2}, {0, 2, 3}};
  const auto mesh = TriangleMesh::from_positions(positions, faces);
  EXPECT_THROW(methods::heat_distance(mesh), InvalidGeometry);
  EXPECT_THROW(methods::heat_distance(mesh, 0.0), InvalidArgument);
}

#ifdef AHM_METHODS_CGAL

TEST(ExactDistance, IsThePlanesOnAConvexFlatMesh) {
  const Mesh mesh = flat_square(21);
  const Method exact = methods::exact_distance(mesh.positions, mesh.faces);
  for (Index source : {0, 220}) {
    const Result result = exact->solve(source);
    for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_NEAR(result.distance[i], plane_distance(mesh, source, i), 1e-12);
  }
}

TEST(ExactDistance, UnfoldsTheCube) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const std::vector<Triangle> faces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Result result = methods::exact_distance(corners, faces)->solve(0);
  for (Index i = 0; i < 8; ++i) {
    const double axes = corners[i][0] + corners[i][1] + corners[i][2];
    // To the opposite corner across two faces: the diagonal of a 1 x 2 rectangle.
    EXPECT_NEAR(result.distance[i], axes == 3 ? std::sqrt(5.0) : std::sqrt(axes), 1e-14);
  }
}

TEST(ExactDistance, IsNoLongerThanAnyPathOfEdges) {
  const Mesh mesh = icosphere(8);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
  const Result exact = methods::exact_distance(mesh.positions, mesh.faces)->solve(3);
  const CsrGraph& graph = surface.graph();
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      ASSERT_LE(exact.distance[i], exact.distance[star.neighbors[e]] +
                                       std::hypot(star.log(e)[0], star.log(e)[1]) * graph.length_unit() + 1e-12);
    const double great_circle = std::acos(std::clamp(dot(mesh.positions[3], mesh.positions[i]), -1.0, 1.0));
    ASSERT_LE(exact.distance[i], great_circle + 1e-12);  // the polyhedron lies inside the sphere
  }
}

TEST(ExactDistance, ReachesNoOtherComponent) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}, {9, 9, 9}};
  const std::vector<Triangle> faces{{0, 1, 2}, {3, 4, 5}};
  const Method exact = methods::exact_distance(positions, faces);
  const Result result = exact->solve(1);
  for (Index i = 0; i < 7; ++i) EXPECT_EQ(std::isfinite(result.distance[i]), i < 3) << i;
  EXPECT_THROW(exact->solve(6), InvalidArgument);
}

TEST(ExactDistance, RefusesFacesThatAreNoOrientedManifold) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_THROW(methods::exact_distance(positions, std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}}), InvalidGeometry);
  EXPECT_THROW(methods::exact_distance(positions, std::vector<Triangle>{{0, 1, 7}}), InvalidGeometry);
}

#endif

}  // namespace
}  // namespace ahm::test
