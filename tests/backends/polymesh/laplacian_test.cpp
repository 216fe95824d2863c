// The Laplacian and mass [BHKB20].
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

Eigen::MatrixXd stiffness(const TangentGraph& graph) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(graph.size(), graph.size());
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      K(i, star.neighbors[e]) -= star.weights[e];
      K(i, i) += star.weights[e];
    }
  }
  return K;
}

double total_mass(const TangentGraph& graph) {
  double sum = 0;
  for (Index i = 0; i < graph.size(); ++i) sum += graph.mass(i);
  return sum * graph.length_unit() * graph.length_unit();
}

TEST(PolygonLaplacian, IsPositiveSemiDefiniteWithConstantsAsKernel) {
  for (const Polygons& mesh :
       {voronoi_square(60), l_shapes(6, 20.0), u_shapes(5), cube_sphere(5), voronoi_sphere(60)}) {
    const auto surface = build(mesh, {.clamp_weights = false});
    const Eigen::MatrixXd K = stiffness(surface.graph());
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    EXPECT_GT(eigenvalues[0], -1e-10 * eigenvalues[eigenvalues.size() - 1]);
    EXPECT_GT(eigenvalues[1], 1e-9 * eigenvalues[eigenvalues.size() - 1]) << "one constant per component";
  }
}

TEST(PolygonLaplacian, IsExactForLinearFunctionsOnThePlane) {
  // u(x) = a . x has energy |a|^2 x area, and no Laplacian inside.
  struct Case {
    Polygons mesh;
    double width, slant;
  };
  for (const auto& [mesh, width, slant] : {Case{voronoi_square(60), 1, 0}, Case{l_shapes(6), 1, 0.4},
                                           Case{brick_wall(8), 2, 0}, Case{quad_grid(9), 1, 0}}) {
    const auto surface = build(mesh, {.clamp_weights = false});
    const Eigen::MatrixXd K = stiffness(surface.graph());
    Eigen::VectorXd u(mesh.vertices());
    for (Index i = 0; i < mesh.vertices(); ++i) u[i] = 0.6 * mesh.plane[i][0] - 0.8 * mesh.plane[i][1];
    EXPECT_NEAR(u.dot(K * u), width, 1e-10);
    EXPECT_NEAR(total_mass(surface.graph()), width, 1e-12);
    const Eigen::VectorXd Ku = K * u;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double y = mesh.plane[i][1], x = mesh.plane[i][0] - slant * y;
      if (x > 1e-9 && x < width - 1e-9 && y > 1e-9 && y < 1 - 1e-9) EXPECT_NEAR(Ku[i], 0, 1e-10);
    }
  }
}

// As published and, where both kinds of faces must do the same about negative weights and slivers on the boundary, without them.
TEST(PolygonLaplacian, IsTheCotanLaplacianOnTriangles) {
  Polygons grid = quad_grid(12, true);
  Polygons sphere = quad_grid(12, true);  // bent
  for (Vec3& p : sphere.positions) p[2] += 0.3 * p[0] * p[0] - 0.2 * p[0] * p[1];
  const Mesh dented = dented_square(12);
  Polygons slivers;
  for (const Vec3& p : dented.positions) slivers.positions.push_back({p[0] + 0.3 * p[1], p[1], 0.1 * p[0] * p[1]});
  for (const Triangle& t : dented.faces) slivers.add({t.begin(), t.end()});
  for (const Polygons& mesh : {grid, sphere, slivers})
    for (const bool clamp : {false, true}) {
      std::vector<Triangle> triangles;
      for (Index f = 0; f < mesh.faces(); ++f) triangles.push_back({mesh.face(f)[0], mesh.face(f)[1], mesh.face(f)[2]});
      const auto cotan = trimesh::TriangleMeshSurface::build(mesh.positions, triangles,
                                                             {.intrinsic_delaunay = false, .clamp_weights = clamp});
      const auto surface = build(mesh, {.clamp_weights = clamp});
      const Eigen::MatrixXd K = stiffness(surface.graph()), L = stiffness(cotan.graph());
      EXPECT_LT((K - L).cwiseAbs().maxCoeff(), 1e-11 * L.cwiseAbs().maxCoeff()) << clamp;
      for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_NEAR(surface.graph().mass(i), cotan.graph().mass(i), 1e-13);
    }
}

TEST(PolygonLaplacian, GivesTheMapOfTheTriangleBackendOnThePlane) {
  const Polygons mesh = quad_grid(20, true);
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.faces(); ++f) triangles.push_back({mesh.face(f)[0], mesh.face(f)[1], mesh.face(f)[2]});
  const auto other = trimesh::TriangleMeshSurface::build(mesh.positions, triangles, {.intrinsic_delaunay = false});
  const auto surface = build(mesh);
  const Vec3 u{1, 0.2, 0};
  const LogMap a = LogMapSolver(surface.graph()).solve(surface.source(Row(200), u).source);
  const LogMap b = LogMapSolver(other.graph()).solve(other.source(Row(200), u).source);
  for (Index i = 0; i < mesh.vertices(); ++i)
    for (int c : {0, 1}) ASSERT_NEAR(a.coordinates(Vertex(i))[c], b.coordinates(Vertex(i))[c], 1e-11);
}

TEST(PolygonRefinement, KeepsTrianglesAndFlatness) {
  const Polygons triangles = quad_grid(6, true), quads = quad_grid(6), cells = voronoi_square(100);
  const auto plain =
      polymesh::PolygonMesh::from_faces(triangles.positions, triangles.begin, triangles.corners).refined();
  EXPECT_EQ(plain.positions.size(), triangles.positions.size());
  EXPECT_EQ(plain.triangles.size(), static_cast<std::size_t>(triangles.faces()));
  const auto fans = polymesh::PolygonMesh::from_faces(quads.positions, quads.begin, quads.corners).refined();
  EXPECT_EQ(fans.positions.size(), quads.positions.size() + static_cast<std::size_t>(quads.faces()));
  EXPECT_EQ(fans.triangles.size(), static_cast<std::size_t>(4 * quads.faces()));
  EXPECT_EQ(fans.face_begin.size(), static_cast<std::size_t>(quads.faces()) + 1);

  const auto refined = polymesh::PolygonMesh::from_faces(cells.positions, cells.begin, cells.corners).refined();
  EXPECT_TRUE(refined.folded.empty());
  const auto surface = trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(7)).source);
  for (Index i = 0; i < cells.vertices(); ++i) {
    const double exact = std::hypot(cells.plane[i][0] - cells.plane[7][0], cells.plane[i][1] - cells.plane[7][1]);
    ASSERT_NEAR(map.distance(Vertex(i)), exact, 1e-11);
  }
}

TEST(PolygonRefinement, CutsFacesThatHideASideAlongDiagonals) {
  const Polygons mesh = u_shapes(4);
  const auto refined = polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
  EXPECT_TRUE(refined.folded.empty());
  EXPECT_EQ(refined.positions.size(), mesh.positions.size() + 16);  // virtual vertices in the squares alone
  const auto surface = trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(7)).source);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double exact = std::hypot(mesh.plane[i][0] - mesh.plane[7][0], mesh.plane[i][1] - mesh.plane[7][1]);
    ASSERT_NEAR(map.distance(Vertex(i)), exact, 1e-11);
  }
}

TEST(PolygonRefinement, NamesTwistedFacesAndBendsTwistedQuads) {
  // A square, and beside it a pentagon or a quad whose outline crosses itself.
  Polygons mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 1.5, 0}, {3, -1, 0}, {2, -0.5, 0}},
                {0, 4, 9},
                {0, 1, 2, 3, 2, 1, 4, 5, 6},
                {}};
  EXPECT_EQ(polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined().folded,
            std::vector<Index>{1});
  mesh.corners.pop_back();
  --mesh.begin.back();
  const auto refined = polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
  EXPECT_TRUE(refined.folded.empty());
  EXPECT_EQ(refined.triangles.size(), 6u);
}

}  // namespace
}  // namespace ahm::test
