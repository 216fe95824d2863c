// A bad mesh leads to an error that names the fault, or to a map with a status per row.
#include "ahm/conformance/paper_band.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "meshes.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

void expect_invalid(const Mesh& mesh, const std::string& text) {
  expect_error<InvalidGeometry>([&] { build(mesh); }, text);
}

void repeat_faces(Mesh& mesh) {
  for (Index f = 0; f < 12; ++f) mesh.faces.push_back(mesh.faces[f]);
}

TEST(MeshFaults, AreNamed) {
  const std::pair<const char*, void (*)(Mesh&)> cases[] = {
      {"no vertices", [](Mesh& mesh) { mesh = {}; }},
      {"no faces", [](Mesh& mesh) { mesh.faces.clear(); }},
      {"face 7", [](Mesh& mesh) { mesh.faces[7][1] = mesh.vertices(); }},
      {"outside [0, 42)", [](Mesh& mesh) { mesh.faces[7][1] = -1; }},
      {"uses a vertex twice: face 7", [](Mesh& mesh) { mesh.faces[7][1] = mesh.faces[7][0]; }},
      {"face 80 repeats face 3", [](Mesh& mesh) { mesh.faces.push_back(mesh.faces[3]); }},
      {"face 80 repeats face 3",
       [](Mesh& mesh) {
         mesh.faces.push_back({mesh.faces[3][1], mesh.faces[3][0], mesh.faces[3][2]});
       }},
      {"face 1 repeats face 0",
       [](Mesh& mesh) {
         mesh.faces = {{0, 1, 2}, {2, 1, 0}};
       }},
      {"12 faces", repeat_faces},
      {"and 2 more", repeat_faces},
      {"vertex 5", [](Mesh& mesh) { mesh.positions[5][1] = NAN; }},
      {"inf", [](Mesh& mesh) { mesh.positions[5][1] = INFINITY; }},
      {"same place",
       [](Mesh& mesh) {
         std::ranges::fill(mesh.positions, Vec3{1, 2, 3});
       }},
  };
  for (const auto& [text, damage] : cases) {
    Mesh mesh = icosphere(2);
    damage(mesh);
    expect_invalid(mesh, text);
  }
  std::stop_source stop;
  stop.request_stop();
  MeshOptions stopped;
  stopped.progress.stop = stop.get_token();
  EXPECT_THROW(build(icosphere(4), stopped), Cancelled);
}

TEST(MeshFaults, OfEdgeLengthsAreRefused) {
  const std::vector<Triangle> faces{{0, 1, 2}, {1, 0, 3}};
  using Lengths = std::vector<std::array<double, 3>>;
  for (const Lengths& lengths : {Lengths{{1, 1, 1}}, Lengths{{1, 1, 1}, {NAN, 1, 1}}, Lengths{{1, 1, 1}, {1, 1, -1}},
                                 Lengths{{1, 1, 1}, {1, 1, 3}}, Lengths{{1, 1, 1}, {1.1, 1, 1}}})
    EXPECT_THROW(TriangleMesh::from_edge_lengths(4, faces, lengths), InvalidGeometry);
  EXPECT_NO_THROW(TriangleMesh::from_edge_lengths(4, faces, Lengths{{1, 1, 1}, {1, 1, 1}}));
}

TEST(MeshFaults, UnreferencedVerticesAreRemoved) {
  Mesh mesh = icosphere(6);
  const RowLogMap clean = SolvedMesh(mesh).map(Row(0));
  mesh.positions.insert(mesh.positions.begin(), {9, 9, 9});
  mesh.positions.push_back({8, 8, 8});
  for (auto& t : mesh.faces)
    for (Index& v : t) ++v;
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().topology.unreferenced, 2);
  const RowLogMap map = solved.map(Row(1));
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status.front(), Status::removed);
  EXPECT_EQ(map.status.back(), Status::removed);
  expect_near(std::span(map.distance).subspan(1), clean.distance, 1e-12);
  EXPECT_THROW(solved.surface.source(Row(0)), InvalidArgument);
}

TEST(MeshFaults, EdgesOfThreeFacesAreNamedOrSplit) {
  Mesh mesh = holed_square(12);
  const auto [a, b, c] = mesh.faces[40];
  const Index fin = mesh.vertices();
  mesh.positions.push_back(mesh.positions[c] + Vec3{0, 0, 1});
  mesh.faces.push_back({a, b, fin});
  expect_invalid(mesh, "(" + std::to_string(std::min(a, b)) + ", " + std::to_string(std::max(a, b)) + ") with 3 faces");
  const SolvedMesh solved(mesh, {.non_manifold = NonManifold::split});
  EXPECT_EQ(solved.surface.details().topology.non_manifold_edges, 1);
  EXPECT_FALSE(solved.surface.warnings().empty());
  const RowLogMap map = solved.map(Row(0));
  expect_nan_exactly_where_not_ok(map);
  EXPECT_EQ(map.status[fin], Status::disconnected);
  EXPECT_EQ(map.status[a], Status::ok);  // the copy on the source's sheet
}

TEST(MeshFaults, BowTiesAreNamedOrSplit) {
  Mesh mesh = joined(holed_square(8), holed_square(9), {4, 0, 0});
  const Index cut = holed_square(8).vertices();
  for (auto& t : mesh.faces) std::ranges::replace(t, cut, 5);  // both squares share vertex 5
  expect_invalid(mesh, "bow ties): 5");
  const SolvedMesh solved(mesh, {.non_manifold = NonManifold::split});
  EXPECT_EQ(solved.surface.details().topology.components, 2);
  EXPECT_EQ(solved.surface.details().topology.non_manifold_vertices, 1);
  const RowLogMap map = solved.map(Row(cut + 7));
  EXPECT_EQ(map.status[5], Status::ok);
  EXPECT_EQ(map.status[6], Status::disconnected);
  EXPECT_EQ(map.status[cut], Status::removed);
}

TEST(MeshFaults, FlatCapsAreFlippedAwayWithoutMollification) {
  // T-junctions closed by triangles without area.
  const Mesh mesh = at_plane({{},
                              {{0, 1, 2}, {0, 5, 3}, {4, 2, 3}, {0, 2, 4}, {5, 4, 3}, {0, 4, 5}},
                              {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.25, 0.25}}});
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().degenerate_faces, 2);
  EXPECT_EQ(solved.surface.details().mollification, 0);
  EXPECT_LT(plane_error(mesh, solved.map(Row(1), Vec3{1, 0, 0}), {1, 0}, {1, 0}), 1e-13);
}

TEST(MeshFaults, FacesWhoseCornersLieOnALineAreNamed) {
  const Mesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}}, {{3, 0, 1}, {3, 1, 2}, {0, 2, 1}, {2, 0, 4}}, {}};
  EXPECT_EQ(find_warning(build(mesh), "collinear_faces").value().numbers, (std::vector<double>{1, 2}));
}

TEST(MeshFaults, ThinSliversAtTheBoundaryHardlyChangeTheMap) {
  const Mesh mesh = holed_square(15);
  for (double height : {1e-6, 1e-12, 0.0}) {
    Mesh other = mesh;
    for (const auto& [a, b, c] : mesh.faces) {
      if (mesh.plane[a][1] != 0 || mesh.plane[b][1] != 0) continue;
      other.faces.push_back({b, a, static_cast<Index>(other.plane.size())});
      other.plane.push_back({0.5 * (mesh.plane[a][0] + mesh.plane[b][0]), -height});
    }
    other = at_plane(other);
    const RowLogMap map = SolvedMesh(other).map(Row(0), Vec3{1, 0, 0});
    EXPECT_LT(plane_error(other, map, other.plane[0], {1, 0}), 1e-5) << height;
  }
}

TEST(MeshFaults, EdgeLengthsMaySpanManyOrdersOfMagnitude) {
  Mesh mesh = holed_square(20);
  for (auto& [x, y] : mesh.plane) x = std::pow(x, 12), y *= 1e-9 + x;
  mesh = at_plane(mesh);
  const SolvedMesh solved(mesh);
  EXPECT_GT(solved.surface.details().longest_edge, 1e6 * solved.surface.details().shortest_edge);
  EXPECT_FALSE(solved.surface.warnings().empty());
  expect_nan_exactly_where_not_ok(solved.map(Row(mesh.vertices() - 1)));
}

TEST(MeshFaults, MoebiusBandsHaveFramesAndTextures) {
  const Mesh mesh = moebius_mesh(80, 8);
  for (bool flips : {true, false}) {
    const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
    const SurfaceSource source = solved.surface.source(FacePoint{200, {0.2, 0.5, 0.3}});
    const LogMap map = solved.solver.solve(source.source);
    EXPECT_EQ(map.count(Status::ok), mesh.vertices());
    for (Index i = 0; i < mesh.vertices(); ++i) {  // at least about the chord, less than around the band
      const double found = map.distance(solved.surface.vertex(Row(i)));
      ASSERT_GT(found, 0.9 * distance(mesh.positions[i], source.frame->origin) - 0.02);
      ASSERT_LT(found, 4);
    }
    EXPECT_EQ(solved.surface.to_corners(map).size(), 3 * mesh.faces.size());
  }
}

TEST(MeshFaults, AMoebiusBandOfPaperIsAsFlatAsItsStrip) {
  const PaperBand band = paper_band(60, 12);
  const auto at = [&](const FacePoint& point) {  // in the strip
    Vec2 p{0, 0};
    for (int s = 0; s < 3; ++s) p = p + point.barycentric[s] * band.corners[3 * point.face + s];
    return p;
  };
  for (bool flips : {true, false}) {
    const auto surface = TriangleMeshSurface::build(
        TriangleMesh::from_edge_lengths(static_cast<Index>(band.plane.size()), band.faces, band.lengths),
        {.intrinsic_delaunay = flips});
    EXPECT_FALSE(surface.details().topology.orientable);
    EXPECT_EQ(surface.details().topology.boundary_loops, 1);
    EXPECT_EQ(surface.graph().transport_kind(), TransportKind::block);
    EXPECT_NO_THROW(validate(surface.graph()));
    if (flips) EXPECT_GT(surface.details().flips, 100);
    const LogMapSolver solver(surface.graph());
    // Sources in faces all around the band, some at the twist. Within a third of the band the other direction is far.
    for (Index f = 7; f < std::ssize(band.faces); f += 131)
      for (Variant variant : all_variants) {
        SCOPED_TRACE(f);
        const FacePoint source{f, {0.2, 0.5, 0.3}};
        const auto expect_exact = [&](double found, const Vec2& place, double reach) {
          const double d = band.distance(at(source), place);
          if (d < reach) EXPECT_NEAR(found, d, 1e-6) << place[0] << ", " << place[1];
        };
        const LogMap raw = solver.solve(surface.source(source).source, {.variant = variant});
        const RowLogMap map = surface.to_rows(raw);
        for (std::size_t i = 0; i < band.plane.size(); ++i) expect_exact(map.distance[i], band.plane[i], 0.3);
        const auto corners = surface.to_corners(raw);
        for (std::size_t k = 0; k < corners.size(); ++k) expect_exact(length(corners[k]), band.corners[k], 0.25);
        for (Index g = 0; g < std::ssize(band.faces); g += 17) {
          const FacePoint middle{g, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
          const Sample sample = surface.at(raw, middle);
          expect_exact(std::hypot(sample.u, sample.v), at(middle), 0.25);
        }
      }
  }
}

}  // namespace
}  // namespace ahm::test
