// What a bad mesh gets: an error that names the culprit, or a result with a status per vertex.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ahm/conformance/paper_band.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "support/expect_error.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

using trimesh::MeshOptions;
using trimesh::NonManifold;
using trimesh::TriangleMesh;
using trimesh::TriangleMeshSurface;

template <class Exception>
void expect_error(const Mesh& mesh, const std::string& text, const MeshOptions& options = {}) {
  test::expect_error<Exception>([&] { TriangleMeshSurface::build(mesh.positions, mesh.faces, options); }, text);
}

void expect_nan_exactly_where_not_ok(const RowLogMap& map) {
  for (std::size_t i = 0; i < map.status.size(); ++i)
    for (double x : {map.u[i], map.v[i], map.distance[i], map.angle[i]})
      ASSERT_EQ(std::isnan(x), map.status[i] != Status::ok);
}

TEST(MeshFaults, NothingThere) {
  expect_error<InvalidGeometry>({}, "no vertices");
  expect_error<InvalidGeometry>({{{0, 0, 0}}, {}, {}}, "no faces");
}

TEST(MeshFaults, BadFaces) {
  Mesh mesh = icosphere(2);
  mesh.faces[7][1] = mesh.vertices();
  expect_error<InvalidGeometry>(mesh, "face 7");
  mesh.faces[7][1] = -1;
  expect_error<InvalidGeometry>(mesh, "outside [0, 42)");
  mesh.faces[7][1] = mesh.faces[7][0];
  expect_error<InvalidGeometry>(mesh, "use a vertex twice: face 7");
}

TEST(MeshFaults, DuplicateFaces) {
  Mesh mesh = icosphere(2);
  mesh.faces.push_back(mesh.faces[3]);
  expect_error<InvalidGeometry>(mesh, "face 80 repeats face 3");
  mesh.faces.back() = {mesh.faces[3][1], mesh.faces[3][0], mesh.faces[3][2]};
  expect_error<InvalidGeometry>(mesh, "1 faces have a duplicate");
  Mesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}, {}};
  expect_error<InvalidGeometry>(pillow, "face 1 repeats face 0");
}

TEST(MeshFaults, CoordinatesThatAreNotFinite) {
  Mesh mesh = icosphere(2);
  mesh.positions[5][1] = NAN;
  expect_error<InvalidGeometry>(mesh, "vertex 5");
  mesh.positions[5][1] = INFINITY;
  expect_error<InvalidGeometry>(mesh, "inf");
}

TEST(MeshFaults, UnreferencedVerticesAreMasked) {
  Mesh mesh = icosphere(6);
  const RowLogMap clean = SolvedMesh(mesh).map(SolvedMesh(mesh).surface.source(Row(0)).source);
  mesh.positions.insert(mesh.positions.begin(), {9, 9, 9});
  mesh.positions.push_back({8, 8, 8});
  for (auto& t : mesh.faces)
    for (Index& v : t) ++v;
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().topology.unreferenced, 2);
  const RowLogMap map = solved.map(solved.surface.source(Row(1)).source);
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status.front(), Status::removed);
  EXPECT_EQ(map.status.back(), Status::removed);
  for (std::size_t i = 0; i < clean.u.size(); ++i) ASSERT_NEAR(map.distance[i + 1], clean.distance[i], 1e-12);
  EXPECT_THROW(solved.surface.source(Row(0)), InvalidArgument);
}

TEST(MeshFaults, OtherComponentsAreMasked) {
  const Mesh one = icosphere(6), both = joined(one, icosphere(5), {5, 0, 0});
  const SolvedMesh alone(one), solved(both);
  EXPECT_EQ(solved.surface.details().topology.components, 2);
  const RowLogMap map = solved.map(solved.surface.source(Row(3)).source);
  expect_nan_exactly_where_not_ok(map);
  for (Index i = 0; i < both.vertices(); ++i)
    ASSERT_EQ(map.status[i], i < one.vertices() ? Status::ok : Status::disconnected);
}

TEST(MeshFaults, EdgesOfThreeFaces) {
  Mesh mesh = holed_square(12);
  const auto [a, b, c] = mesh.faces[40];
  const Index fin = mesh.vertices();
  Vec3 p = mesh.positions[c];
  p[2] += 1;
  mesh.positions.push_back(p);
  mesh.faces.push_back({a, b, fin});
  expect_error<InvalidGeometry>(mesh, "1 edges have more than two faces: (" + std::to_string(std::min(a, b)) + ", " +
                                          std::to_string(std::max(a, b)) + ") with 3 faces");
  const SolvedMesh solved(mesh, {.non_manifold = NonManifold::split});
  EXPECT_EQ(solved.surface.details().topology.non_manifold_edges, 1);
  EXPECT_FALSE(solved.surface.warnings().empty());
  const RowLogMap map = solved.map(solved.surface.source(Row(0)).source);
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status[fin], Status::disconnected);
  EXPECT_EQ(map.status[a], Status::ok);  // the copy on the source's sheet
}

TEST(MeshFaults, BowTies) {
  Mesh mesh = joined(holed_square(8), holed_square(9), {4, 0, 0});
  const Index cut = holed_square(8).vertices();
  for (auto& t : mesh.faces)
    for (Index& v : t)
      if (v == cut) v = 5;  // both squares now share vertex 5
  expect_error<InvalidGeometry>(mesh, "bow ties): 5");
  const SolvedMesh solved(mesh, {.non_manifold = NonManifold::split});
  EXPECT_EQ(solved.surface.details().topology.components, 2);
  EXPECT_EQ(solved.surface.details().topology.non_manifold_vertices, 1);
  const RowLogMap map = solved.map(solved.surface.source(Row(cut + 7)).source);
  EXPECT_EQ(map.status[5], Status::ok);
  EXPECT_EQ(map.status[6], Status::disconnected);
  EXPECT_EQ(map.status[cut], Status::removed);
}

TEST(MeshFaults, TheFirstTenAreListed) {
  Mesh mesh = icosphere(3);
  for (Index f = 0; f < 12; ++f) mesh.faces.push_back(mesh.faces[f]);
  expect_error<InvalidGeometry>(mesh, "12 faces have a duplicate");
  expect_error<InvalidGeometry>(mesh, "and 2 more");
}

TEST(MeshFaults, MoebiusBandsAreSolvedWithReflections) {
  const Mesh mesh = moebius_mesh(80, 8);
  for (bool flips : {true, false}) {
    const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
    EXPECT_FALSE(solved.surface.details().topology.orientable);
    EXPECT_EQ(solved.surface.details().topology.boundary_loops, 1);
    EXPECT_EQ(solved.surface.graph().transport_kind(), TransportKind::block);
    EXPECT_NO_THROW(validate(solved.surface.graph()));
    const LogMap raw = solved.solver.solve(solved.surface.source(FacePoint{200, {0.2, 0.5, 0.3}}).source);
    const RowLogMap map = solved.surface.to_rows(raw);
    expect_nan_exactly_where_not_ok(map);
    for (Index i = 0; i < mesh.vertices(); ++i) {
      ASSERT_EQ(map.status[i], Status::ok);
      // No shorter than the chord, no longer than round the band.
      const Frame at = *solved.surface.source(FacePoint{200, {0.2, 0.5, 0.3}}).frame;
      const double chord = std::hypot(mesh.positions[i][0] - at.origin[0], mesh.positions[i][1] - at.origin[1],
                                      mesh.positions[i][2] - at.origin[2]);
      ASSERT_GT(map.distance[i], 0.9 * chord - 0.02);
      ASSERT_LT(map.distance[i], 4);
    }
    EXPECT_EQ(solved.surface.to_corners(raw).size(), 3 * mesh.faces.size());
  }
}

TEST(MeshFaults, AMoebiusBandOfPaperIsAsFlatAsItsStrip) {
  const PaperBand band = paper_band(60, 12);
  for (bool flips : {true, false}) {
    const auto surface = TriangleMeshSurface::build(
        TriangleMesh::from_edge_lengths(static_cast<Index>(band.plane.size()), band.faces, band.lengths),
        {.intrinsic_delaunay = flips});
    EXPECT_EQ(surface.graph().transport_kind(), TransportKind::block);
    if (flips) {
      EXPECT_GT(surface.details().flips, 100);
    }
    const LogMapSolver solver(surface.graph());
    // Sources in faces all round the band, some at the twist; within a third of the band the other way round is far.
    for (std::size_t f = 7; f < band.faces.size(); f += 131)
      for (Variant variant : all_variants) {
        const FacePoint point{static_cast<Index>(f), {0.2, 0.5, 0.3}};
        std::array<double, 2> p{0, 0};
        for (int s = 0; s < 3; ++s)
          for (int a = 0; a < 2; ++a) p[a] += point.barycentric[s] * band.corners[3 * f + s][a];
        const LogMap raw = solver.solve(surface.source(point).source, {.variant = variant});
        const RowLogMap map = surface.to_rows(raw);
        for (std::size_t i = 0; i < band.plane.size(); ++i)
          if (const double d = band.distance(p, band.plane[i]); d < 0.3) {
            EXPECT_NEAR(map.distance[i], d, 1e-6) << f << ", " << i;
          }
        const auto corners = surface.to_corners(raw);
        for (std::size_t k = 0; k < corners.size(); ++k)
          if (const double d = band.distance(p, band.corners[k]); d < 0.25) {
            EXPECT_NEAR(std::hypot(corners[k][0], corners[k][1]), d, 1e-6) << f << ", corner " << k;
          }
        for (Index g = 0; g < static_cast<Index>(band.faces.size()); g += 17) {
          std::array<double, 2> q{0, 0};
          for (int s = 0; s < 3; ++s)
            for (int a = 0; a < 2; ++a) q[a] += band.corners[3 * g + s][a] / 3;
          if (band.distance(p, q) > 0.25) continue;
          const auto sample = surface.at(raw, FacePoint{g, {1.0 / 3, 1.0 / 3, 1.0 / 3}});
          EXPECT_NEAR(std::hypot(sample.u, sample.v), band.distance(p, q), 1e-6) << f << ", face " << g;
        }
      }
  }
}

TEST(MeshFaults, FlatCapsAreFlippedAwayWithoutMollification) {
  // T-junctions closed by triangles of no area.
  Mesh mesh{{}, {}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.25, 0.25}}};
  for (const auto& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0});
  mesh.faces = {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}};
  mesh.faces[1] = {0, 5, 3};
  mesh.faces.push_back({5, 4, 3});
  mesh.faces.push_back({0, 4, 5});
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().degenerate_faces, 2);
  EXPECT_EQ(solved.surface.details().mollification, 0);
  const RowLogMap map = solved.map(solved.surface.source(Row(1), Vec3{1, 0, 0}).source);
  EXPECT_LT(plane_error(mesh, map, {1, 0}, {1, 0}), 1e-13);
}

TEST(MeshFaults, NamesFacesWhoseCornersLieOnALine) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}};
  const std::vector<Triangle> faces{{3, 0, 1}, {3, 1, 2}, {0, 2, 1}, {2, 0, 4}};
  const auto warnings = TriangleMeshSurface::build(positions, faces).warnings();
  const auto warning = std::ranges::find(warnings, "collinear_faces", &Warning::id);
  ASSERT_NE(warning, warnings.end());
  EXPECT_EQ(warning->numbers, (std::vector<double>{1, 2}));
}

TEST(MeshFaults, ThinSliversAtTheBoundary) {
  Mesh mesh = holed_square(15);
  // A vertex 1e-12 beside a boundary edge.
  for (double height : {1e-6, 1e-12, 0.0}) {
    Mesh other = mesh;
    for (const auto& t : mesh.faces) {
      if (mesh.plane[t[0]][1] != 0 || mesh.plane[t[1]][1] != 0) continue;
      const auto &p = mesh.plane[t[0]], &q = mesh.plane[t[1]];
      other.plane.push_back({0.5 * (p[0] + q[0]), -height});
      other.faces.push_back({t[1], t[0], other.vertices()});
      other.positions.push_back({});
    }
    for (std::size_t i = 0; i < other.plane.size(); ++i) other.positions[i] = {other.plane[i][0], other.plane[i][1], 0};
    const SolvedMesh solved(other);
    const RowLogMap map = solved.map(solved.surface.source(Row(0), Vec3{1, 0, 0}).source);
    EXPECT_LT(plane_error(other, map, other.plane[0], {1, 0}), 1e-5) << height;
  }
}

TEST(MeshFaults, AllVerticesAtOnePlace) {
  Mesh mesh = icosphere(2);
  for (Vec3& p : mesh.positions) p = {1, 2, 3};
  expect_error<InvalidGeometry>(mesh, "same place");
}

TEST(MeshFaults, EdgeLengthsOverManyOrdersOfMagnitude) {
  Mesh mesh = holed_square(20);
  for (std::size_t i = 0; i < mesh.plane.size(); ++i) {
    mesh.plane[i] = {std::pow(mesh.plane[i][0], 12), mesh.plane[i][1]};
    mesh.positions[i] = {mesh.plane[i][0], mesh.plane[i][1] * (1e-9 + mesh.plane[i][0]), 0};
    mesh.plane[i] = {mesh.positions[i][0], mesh.positions[i][1]};
  }
  const SolvedMesh solved(mesh);
  EXPECT_GT(solved.surface.details().longest_edge, 1e6 * solved.surface.details().shortest_edge);
  EXPECT_FALSE(solved.surface.warnings().empty());
  expect_nan_exactly_where_not_ok(solved.map(solved.surface.source(Row(mesh.vertices() - 1)).source));
}

TEST(MeshFaults, BadEdgeLengths) {
  const std::vector<Triangle> faces{{0, 1, 2}, {1, 0, 3}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Lengths = std::vector<std::array<double, 3>>;
  for (const Lengths& lengths : {Lengths{{1, 1, 1}}, Lengths{{1, 1, 1}, {nan, 1, 1}}, Lengths{{1, 1, 1}, {1, 1, -1}},
                                 Lengths{{1, 1, 1}, {1, 1, 3}}, Lengths{{1, 1, 1}, {1.1, 1, 1}}})
    EXPECT_THROW(TriangleMesh::from_edge_lengths(4, faces, lengths), InvalidGeometry);
  EXPECT_NO_THROW(TriangleMesh::from_edge_lengths(4, faces, Lengths{{1, 1, 1}, {1, 1, 1}}));
}

TEST(MeshFaults, BuildingCanBeStopped) {
  std::stop_source stop;
  stop.request_stop();
  MeshOptions options;
  options.progress.stop = stop.get_token();
  const Mesh mesh = icosphere(4);
  EXPECT_THROW(TriangleMeshSurface::build(mesh.positions, mesh.faces, options), Cancelled);
}

}  // namespace
}  // namespace ahm::test
