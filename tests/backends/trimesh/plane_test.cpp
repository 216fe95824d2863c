// On the plane the map is the identity for any triangles, also for faces that are arbitrarily thin.
#include "ahm/fields/vector_heat.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/quality.hpp"
#include "thin_meshes.hpp"

namespace ahm::test {
namespace {

std::vector<std::pair<std::string, Mesh>> flat_cases() {
  return {{"slivers", sliver_square(600)},
          {"slivers 2", sliver_square(1500, 7)},
          {"holes", holed_square(40)},
          {"needles", holed_square(25, 3, 1e-3)},
          {"maze", maze(8)},
          {"folded", folded_strip(25)}};
}

/// Expects the identity from a point inside a face, whose u axis is the direction of the first side.
void expect_identity_from_face(const Mesh& mesh, const RowLogMap& map, const FacePoint& point, double tolerance) {
  const auto& [a, b, c] = mesh.faces[point.face];
  EXPECT_LT(plane_error(mesh, map, plane_point(mesh, point), direction(mesh, a, b)), tolerance)
      << "face " << point.face;
}

TEST(MeshPlane, IsTheIdentityFromAnyPoint) {
  std::mt19937_64 random(3);
  for (const auto& [name, mesh] : flat_cases())
    for (bool flips : {true, false})
      for (Variant variant : all_variants) {
        SCOPED_TRACE(name + (flips ? ", flipped, " : ", ") + std::string(to_string(variant)));
        const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
        const double tolerance = 1e-11 * mesh.diameter();
        for (Index row : {0, 1, 3, mesh.vertices() / 2, mesh.vertices() - 1})
          EXPECT_LT(PlaneErrors(mesh, solved.map(Row(row), variant), mesh.plane[row]).coordinates, tolerance) << row;
        for (int trial = 0; trial < 3; ++trial) {
          const FacePoint point = random_point(mesh, random);
          expect_identity_from_face(mesh, solved.map(point, variant), point, tolerance);
          const auto& [a, b, c] = mesh.faces[point.face];
          const double t = point.barycentric[0];
          EXPECT_LT(plane_error(mesh, solved.map(EdgePoint{Row(c), Row(a), t}, variant),
                                mesh.plane_point(point.face, {t, 0, 1 - t}), direction(mesh, c, a)),
                    tolerance)
              << "edge of face " << point.face;
        }
      }
}

TEST(MeshPlane, HasTheAxesOfTheFrame) {
  for (const auto& [name, mesh] : flat_cases()) {
    if (name == "folded") continue;  // its faces are not in one plane
    const SolvedMesh solved(mesh);
    for (Index source : {0, mesh.vertices() / 2}) {
      const Frame frame = *solved.surface.graph().frame(solved.surface.vertex(Row(source)).index);
      EXPECT_LT(flat_error(solved.map(Row(source)), mesh.positions, frame.origin, frame.x, frame.y), 2e-10) << name;
    }
  }
}

TEST(MeshPlane, NeedsNoPositions) {
  const Mesh mesh = holed_square(30);
  const auto surface = TriangleMeshSurface::build(without_positions(mesh));
  EXPECT_FALSE(surface.graph().frame(0).has_value());
  EXPECT_LT(PlaneErrors(mesh, map_of(surface, Row(7)), mesh.plane[7]).coordinates, 1e-11);
  const FacePoint point{11, {0.2, 0.3, 0.5}};
  expect_identity_from_face(mesh, map_of(surface, point), point, 1e-11);
}

// Values given at vertices extend to the nearest ones. No flip removes slivers on the boundary; heat must not diffuse along them
// as if they had no length.
TEST(MeshPlane, HeatDoesNotRunAlongSliversOnTheBoundary) {
  const Index n = 41;
  const Mesh mesh = dented_square(n);
  const SolvedMesh solved(mesh);
  EXPECT_LT(PlaneErrors(mesh, solved.map(Source::at_vertex(Vertex(3))), mesh.plane[3]).coordinates,
            1e-11 * mesh.diameter());
  const VertexField field = extend_scalar(solved.solver, std::array{Vertex(0), Vertex(n - 1)}, std::array{0.0, 1.0});
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double to_left = length(mesh.plane[i]), to_right = length(mesh.plane[i] - Vec2{n - 1.0, 0});
    if (std::abs(to_left - to_right) > 10)
      ASSERT_NEAR(field.values[i], to_left < to_right ? 0 : 1, 0.01) << "vertex " << i;
  }
}

void expect_identity(const Mesh& mesh, bool flips) {
  const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
  const CsrGraph& graph = solved.surface.graph();
  EXPECT_EQ(solved.surface.details().mollification, 0);
  EXPECT_FALSE(solved.surface.details().flips_stopped);
  EXPECT_NO_THROW(validate(graph));
  for (Variant variant : all_variants)
    for (const auto& [name, point, plane] : places(mesh)) {
      const LogMap map = solved.solver.solve(solved.surface.source(point).source, {.variant = variant});
      const PlaneErrors errors(mesh, solved.surface.to_rows(map), plane);
      EXPECT_LT(errors.coordinates, 1e-9 * mesh.diameter()) << name;
      EXPECT_LT(errors.distance, 1e-9 * mesh.diameter()) << name;
      // Without flips, the quality of long triangles is lower.
      if (graph.is_delaunay()) EXPECT_GT(std::ranges::min(map_quality(graph, map)), 0.9) << name;
    }
}

TEST(ThinFaces, LeaveThePlaneExact) {
  for (bool tilted : {false, true}) {
    for (double thinness : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0}) {
      SCOPED_TRACE(testing::Message() << "thinness " << thinness << ", tilted " << tilted);
      expect_identity(thin_square(17, {thinness}, 12, tilted), true);
    }
    for (bool flips : {true, false})
      for (unsigned seed : {1u, 2u}) {
        SCOPED_TRACE(testing::Message() << "all degrees, tilted " << tilted << ", flips " << flips << ", seed "
                                        << seed);
        expect_identity(thin_square(19, {1e-3, 1e-5, 1e-7, 1e-9, 1e-10, 3e-11, 1e-11, 1e-12, 0.0}, 4, tilted, seed),
                        flips);
      }
  }
}

TEST(ThinFaces, LeaveThePlaneExactFarFromTheOrigin) {
  const Mesh mesh = thin_square(15, {1e-5, 0.0}, 8, true);
  const SolvedMesh solved(moved(mesh, 1e-3, {4, 4, 4}));  // rounding is 1e-12 of the mesh
  EXPECT_EQ(solved.surface.details().mollification, 0);
  for (const auto& [name, point, plane] : places(mesh)) {
    EXPECT_LT(PlaneErrors(mesh, scaled(1e3, solved.map(point)), plane).coordinates, 1e-6) << name;
  }
}

}  // namespace
}  // namespace ahm::test
