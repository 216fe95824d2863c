// Sources anywhere on the surface, and the axes a user asks for.
#include <gtest/gtest.h>

#include <cmath>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

double largest_difference(const RowLogMap& a, const RowLogMap& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i) worst = std::max(worst, std::hypot(a.u[i] - b.u[i], a.v[i] - b.v[i]));
  return worst;
}

TEST(MeshSource, AnEdgeIsTheSamePointInBothItsFaces) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const auto& [a, b, c] = mesh.faces[100];
  const FacePoint here{100, {0.3, 0.7, 0}};
  // The other face with this edge.
  for (Index f = 0; f < static_cast<Index>(mesh.faces.size()); ++f)
    for (int s = 0; s < 3; ++s)
      if (mesh.faces[f][s] == b && mesh.faces[f][(s + 1) % 3] == a) {
        FacePoint there{f, {0, 0, 0}};
        there.barycentric[s] = 0.7;
        there.barycentric[(s + 1) % 3] = 0.3;
        Vec3 along;
        for (int k = 0; k < 3; ++k) along[k] = mesh.positions[b][k] - mesh.positions[a][k];
        const RowLogMap edge = solved.map(solved.surface.source(EdgePoint{Row(a), Row(b), 0.7}).source);
        EXPECT_LT(largest_difference(edge, solved.map(solved.surface.source(here).source)), 1e-11);
        EXPECT_LT(largest_difference(edge, solved.map(solved.surface.source(there, along).source)), 1e-11);
      }
}

TEST(MeshSource, ACornerOfAFaceIsNearlyItsVertex) {
  const Mesh mesh = icosphere(12);
  const SolvedMesh solved(mesh);
  const Vec3 up{0.2, 0.3, 1};
  const RowLogMap vertex = solved.map(solved.surface.source(Row(mesh.faces[50][1]), up).source);
  const RowLogMap corner = solved.map(solved.surface.source(FacePoint{50, {0, 1, 0}}, up).source);
  for (std::size_t i = 0; i < vertex.u.size(); ++i) ASSERT_NEAR(vertex.distance[i], corner.distance[i], 1e-11);
  EXPECT_LT(largest_difference(vertex, corner), 0.1);  // frames of the face and of the vertex differ by curvature
}

TEST(MeshSource, AFaceSourceOnTheSphereIsAsGoodAsAVertexSource) {
  const Mesh mesh = icosphere(24);
  const SolvedMesh solved(mesh);
  const double h = solved.surface.graph().mean_edge_length() * solved.surface.graph().length_unit();
  for (Index f : {3, 700, 5000}) {
    const FacePoint point{f, {0.5, 0.2, 0.3}};
    const Frame frame = *solved.surface.source(point).frame;
    Vec3 p = frame.origin;
    const double r = std::sqrt(dot(p, p));
    for (double& x : p) x /= r;
    const RowLogMap map = solved.map(solved.surface.source(point).source, Variant::localized);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const auto exact = sphere_log(p, frame.x, frame.y, mesh.positions[i]);
      if (std::hypot(exact[0], exact[1]) > 1.5) continue;
      EXPECT_LT(std::hypot(map.u[i] - exact[0], map.v[i] - exact[1]), 0.3 * h) << "face " << f;
    }
  }
}

TEST(MeshSource, FramesAreRightHandedAndTangent) {
  const auto surface = trimesh::TriangleMeshSurface::build(icosphere(6).positions, icosphere(6).faces);
  for (Index v = 0; v < surface.graph().size(); ++v) {
    const Frame f = *surface.graph().frame(v);
    EXPECT_NEAR(dot(f.x, f.y), 0, 1e-14);
    EXPECT_NEAR(dot(f.x, f.x), 1, 1e-14);
    EXPECT_GT(dot(f.normal, f.origin), 0.99);
    EXPECT_NEAR(f.x[1] * f.y[2] - f.x[2] * f.y[1], f.normal[0], 1e-14);
    const auto u = direction_in_frame(surface.graph(), Vertex(v), f.y);
    EXPECT_NEAR(u[0], 0, 1e-14);
    EXPECT_NEAR(u[1], 1, 1e-14);
  }
}

TEST(MeshSource, BadArgumentsAreNamed) {
  const Mesh mesh = icosphere(3);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  EXPECT_THROW(surface.source(Row(-1)), InvalidArgument);
  EXPECT_THROW(surface.source(Row(mesh.vertices())), InvalidArgument);
  EXPECT_THROW(surface.source(Row(0), mesh.positions[0]), InvalidArgument);  // along the normal
  EXPECT_THROW(surface.source(Row(0), Vec3{0, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.source(Row(0), Vec3{NAN, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{static_cast<Index>(mesh.faces.size()), {1, 0, 0}}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{-1, {1, 0, 0}}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{0, {0.5, 0.5, 0.5}}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{0, {1.5, -0.5, 0}}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{0, {NAN, 0.5, 0.5}}), InvalidArgument);
  EXPECT_THROW(surface.source(EdgePoint{Row(mesh.faces[0][0]), Row(mesh.faces[0][1]), 1.5}), InvalidArgument);
  EXPECT_THROW(surface.source(EdgePoint{Row(0), Row(0), 0.5}), InvalidArgument);
  EXPECT_THROW(surface.source(EdgePoint{Row(0), Row(mesh.vertices()), 0.5}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
