// The Laplacian and mass [BHKB20], and the refinement to triangles.
#include <Eigen/Dense>

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

TEST(PolygonLaplacian, IsPositiveSemiDefiniteWithConstantsAsKernel) {
  for (const Polygons& mesh :
       {voronoi_square(60), l_shapes(6, 20.0), u_shapes(5), cube_sphere(5), voronoi_sphere(60)}) {
    const auto surface = build(mesh, {.clamp_weights = false});
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness(surface.graph())).eigenvalues();
    EXPECT_GT(values[0], -1e-10 * values[values.size() - 1]);
    EXPECT_GT(values[1], 1e-9 * values[values.size() - 1]) << "one constant per component";
  }
}

TEST(PolygonLaplacian, IsExactForLinearFunctionsOnThePlane) {
  // u(x) = a . x has the energy |a|^2 x area, and no Laplacian inside.
  struct Case {
    Polygons mesh;
    double width, slant;
  };
  for (const auto& [mesh, width, slant] : {Case{voronoi_square(60), 1, 0}, Case{l_shapes(6), 1, 0.4},
                                           Case{brick_wall(8), 2, 0}, Case{quad_grid(9), 1, 0}}) {
    const auto surface = build(mesh, {.clamp_weights = false});
    const CsrGraph& graph = surface.graph();
    Eigen::VectorXd u(mesh.vertices());
    double area = 0;
    for (Index i = 0; i < mesh.vertices(); ++i) {
      u[i] = 0.6 * mesh.plane[i][0] - 0.8 * mesh.plane[i][1];
      area += graph.mass(i) * graph.length_unit() * graph.length_unit();
    }
    const Eigen::VectorXd Ku = stiffness(graph) * u;
    EXPECT_NEAR(u.dot(Ku), width, 1e-10);
    EXPECT_NEAR(area, width, 1e-12);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double y = mesh.plane[i][1], x = mesh.plane[i][0] - slant * y;
      if (x > 1e-9 && x < width - 1e-9 && y > 1e-9 && y < 1 - 1e-9) EXPECT_NEAR(Ku[i], 0, 1e-10);
    }
  }
}

trimesh::TriangleMeshSurface as_triangles(const Polygons& mesh, bool clamp = true) {
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.faces(); ++f) triangles.push_back({mesh.face(f)[0], mesh.face(f)[1], mesh.face(f)[2]});
  return trimesh::TriangleMeshSurface::build(mesh.positions, triangles,
                                             {.intrinsic_delaunay = false, .clamp_weights = clamp});
}

// Also without clamping; with it, both kinds of meshes treat negative weights and slivers on the boundary equally.
TEST(PolygonLaplacian, IsTheCotanLaplacianOnTriangles) {
  const Polygons grid = quad_grid(12, true);
  Polygons bent = grid, slivers;
  for (Vec3& p : bent.positions) p[2] += 0.3 * p[0] * p[0] - 0.2 * p[0] * p[1];
  const Mesh dented = dented_square(12);
  for (const Vec3& p : dented.positions) slivers.positions.push_back({p[0] + 0.3 * p[1], p[1], 0.1 * p[0] * p[1]});
  for (const Triangle& t : dented.faces) slivers.add({t.begin(), t.end()});
  for (const Polygons& mesh : {grid, bent, slivers})
    for (const bool clamp : {false, true}) {
      const auto cotan = as_triangles(mesh, clamp);
      const auto surface = build(mesh, {.clamp_weights = clamp});
      const Eigen::MatrixXd K = stiffness(surface.graph()), L = stiffness(cotan.graph());
      EXPECT_LT((K - L).cwiseAbs().maxCoeff(), 1e-11 * L.cwiseAbs().maxCoeff()) << clamp;
      for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_NEAR(surface.graph().mass(i), cotan.graph().mass(i), 1e-13);
    }
}

/// Expects that a flat mesh refines without folds to triangles with exact distances.
polymesh::Refinement expect_flat_refinement(const Polygons& mesh) {
  const auto result = refined(mesh);
  EXPECT_TRUE(result.folded.empty());
  const auto surface = trimesh::TriangleMeshSurface::build(result.positions, result.triangles);
  expect_plane_distances(map_of(surface, Row(7)), mesh.plane, 7, 1e-11);
  return result;
}

TEST(PolygonRefinement, KeepsTrianglesAndFlatness) {
  const Polygons triangles = quad_grid(6, true), quads = quad_grid(6);
  const auto plain = expect_flat_refinement(triangles), fans = expect_flat_refinement(quads);
  const auto faces = static_cast<std::size_t>(quads.faces());
  EXPECT_EQ(plain.positions.size(), triangles.positions.size());
  EXPECT_EQ(plain.triangles.size(), 2 * faces);
  EXPECT_EQ(fans.positions.size(), quads.positions.size() + faces);
  EXPECT_EQ(fans.triangles.size(), 4 * faces);
  EXPECT_EQ(fans.face_begin.size(), faces + 1);
  expect_flat_refinement(voronoi_square(100));
  // U shapes are cut along diagonals; only the squares get virtual vertices.
  const Polygons shapes = u_shapes(4);
  EXPECT_EQ(expect_flat_refinement(shapes).positions.size(), shapes.positions.size() + 16);
}

TEST(PolygonRefinement, NamesTwistedFacesAndBendsTwistedQuads) {
  // A square, and next to it a pentagon or a quad whose outline crosses itself.
  Polygons mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 1.5, 0}, {3, -1, 0}, {2, -0.5, 0}},
                {0, 4, 9},
                {0, 1, 2, 3, 2, 1, 4, 5, 6},
                {}};
  EXPECT_EQ(refined(mesh).folded, std::vector<Index>{1});
  mesh.corners.pop_back();
  --mesh.begin.back();
  EXPECT_TRUE(refined(mesh).folded.empty());
  EXPECT_EQ(refined(mesh).triangles.size(), 6u);
}

}  // namespace
}  // namespace ahm::test
