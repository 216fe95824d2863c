// Inspection of meshes that may be invalid, and their repair: a damaged and repaired mesh maps as before, on the input's rows.
#include "ahm/surface/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/util/vec.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

FaceList faces_of(const Polygons& mesh) { return {mesh.begin, mesh.corners}; }

// ------------------------------------------------------------------------------------------------ inspection

MeshInspection inspect(Index vertices, const std::vector<std::vector<Index>>& faces) {
  Polygons mesh;
  for (const auto& face : faces) mesh.add(face);
  return inspect_mesh(vertices, faces_of(mesh));
}

TEST(InspectMesh, CountsHandlesAndHoles) {
  struct Case {
    const char* name;
    Mesh mesh;
    Offset euler_characteristic;
    std::optional<Offset> genus;  ///< none: not orientable
    Index loops;
  };
  for (const auto& [name, mesh, euler_characteristic, genus, loops] :
       {Case{"sphere", icosphere(3), 2, 0, 0}, Case{"torus", torus(500), 0, 1, 0},
        Case{"sheet with two holes", holed_square(16), -1, 0, 3},
        Case{"Moebius band", moebius_mesh(20, 3), 0, std::nullopt, 1}}) {
    SCOPED_TRACE(name);
    const TopologyReport topology = inspect_mesh(mesh.vertices(), faces_of(polygons(mesh))).topology;
    EXPECT_EQ(topology.euler_characteristic, euler_characteristic);
    EXPECT_EQ(topology.genus(), genus);
    EXPECT_EQ(topology.orientable, genus.has_value());
    EXPECT_EQ(topology.boundary_loops, loops);
  }
}

TEST(InspectMesh, CountsNonmanifoldEdgesAndVertices) {
  const TopologyReport pages = inspect(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}).topology;
  EXPECT_EQ(pages.non_manifold_edges, 1);
  EXPECT_EQ(pages.non_manifold_vertices, 2);
  EXPECT_EQ(pages.added_vertices, 4);  // both ends of the edge have three copies instead of one
  EXPECT_EQ(pages.components, 3);
  const TopologyReport bow_tie = inspect(5, {{0, 1, 2}, {0, 3, 4}}).topology;
  EXPECT_EQ(bow_tie.non_manifold_edges, 0);
  EXPECT_EQ(bow_tie.non_manifold_vertices, 1);
  EXPECT_EQ(bow_tie.added_vertices, 1);
  EXPECT_EQ(bow_tie.boundary_loops, 2);
}

TEST(InspectMesh, ListsInvalidFacesAndInspectsTheOthers) {
  const MeshInspection found =
      inspect(5, {{0, 1, 2}, {0, 1, 9}, {2, 1, 3}, {3, 3, 1}, {1, 2, 0}, {0, 1}, {2, 1, 0}, {-1, 0, 1}});
  EXPECT_EQ(found.outside, (std::vector<Index>{1, 7}));
  EXPECT_EQ(found.repeating, std::vector<Index>{3});
  EXPECT_EQ(found.small, std::vector<Index>{5});
  EXPECT_EQ(found.duplicates, (std::vector<Index>{4, 6}));
  EXPECT_EQ(found.topology.faces, 2);
  EXPECT_EQ(found.topology.components, 1);
  EXPECT_EQ(found.topology.unreferenced, 1);
  EXPECT_EQ(found.topology.non_manifold_edges, 0);
  EXPECT_EQ(inspect(3, {}).topology.components, 0);
  EXPECT_EQ(inspect(0, {}).topology.faces, 0);
  EXPECT_EQ(inspect(2, {{0, 1, 2}}).topology.faces, 0);
}

// ------------------------------------------------------------------------------------------------ repair

/// Each triangle has its own corners: corner c of face f is vertex 3 f + c.
Polygons torn(const Mesh& mesh) {
  Polygons result;
  for (const Triangle& t : mesh.faces) {
    const Index first = result.vertices();
    for (Index v : t) result.positions.push_back(mesh.positions[v]);
    result.add({first, first + 1, first + 2});
  }
  return result;
}

RepairedMesh repair(const Polygons& mesh, const RepairOptions& options = RepairOptions::all()) {
  return repair_mesh(mesh.positions, faces_of(mesh), options);
}

RepairedSurface repaired_surface(const Polygons& mesh) {
  const RepairedMesh repaired = repair(mesh);
  const Mesh remaining = triangles(Polygons{mesh.positions, repaired.face_begin, repaired.face_vertices, {}});
  return {std::make_unique<trimesh::TriangleMeshSurface>(trimesh::TriangleMeshSurface::build(
              remaining.positions, remaining.faces, {.non_manifold = NonManifold::split})),
          mesh.positions, repaired};
}

TEST(MeshRepair, DoesNotChangeASoundMesh) {
  const Polygons mesh = polygons(icosphere(2));
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(repaired.counts, RepairCounts{});
  EXPECT_EQ(repaired.face_begin, mesh.begin);
  EXPECT_EQ(repaired.face_vertices, mesh.corners);
  for (Index v = 0; v < mesh.vertices(); ++v) EXPECT_EQ(repaired.joined[v], v);
  for (Index f = 0; f < mesh.faces(); ++f) EXPECT_EQ(repaired.given_face[f], f);
}

TEST(MeshRepair, MakesOnlyTheRequestedRepairs) {
  Polygons mesh = torn(icosphere(1));
  mesh.add({0, 1, 2});
  mesh.add({3, 3, 4});
  const RepairedMesh repaired = repair(mesh, {});
  EXPECT_EQ(repaired.counts, RepairCounts{});
  EXPECT_EQ(repaired.face_vertices, mesh.corners);
  EXPECT_EQ(repair(polygons(moebius_mesh(20, 3)), {.orient = true}).counts.reversed, 0);  // it has no orientation
}

TEST(MeshRepair, ATornMeshMapsAsTheWholeMesh) {
  const Mesh whole = icosphere(3);
  const Polygons mesh = torn(whole);
  const RepairedSurface surface = repaired_surface(mesh);
  EXPECT_EQ(surface.mesh().counts.welded, mesh.vertices() - whole.vertices());
  const auto before = surface_of(whole);
  const Vec3 axis{0.3, 0.2, 0.9};
  const FacePoint inside{5, {0.2, 0.3, 0.5}};
  const LogMapSolver solver(surface.graph()), solver_before(before.graph());
  const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(0), axis).source)),
                  map_before = before.to_rows(solver_before.solve(before.source(Row(whole.faces[0][0]), axis).source)),
                  exact = surface.to_rows(ExactGeodesics(surface).log_map(inside)),
                  exact_before = before.to_rows(ExactGeodesics(before).log_map(inside));
  for (std::size_t row = 0; row < map.u.size(); ++row) {
    const Index v = whole.faces[row / 3][row % 3];
    ASSERT_EQ(map.status[row], Status::ok);
    EXPECT_NEAR(map.u[row], map_before.u[v], 1e-9);
    EXPECT_NEAR(map.v[row], map_before.v[v], 1e-9);
    EXPECT_NEAR(map.distance[row], map_before.distance[v], 1e-9);
    EXPECT_NEAR(exact.distance[row], exact_before.distance[v], 1e-12);
  }
  // Merged rows are sources at the same place. Points of faces and edges have the positions of the torn mesh.
  const std::vector<Index>& joined = surface.mesh().joined;
  const auto twin = static_cast<Index>(std::find(joined.begin() + 1, joined.end(), 0) - joined.begin());
  EXPECT_EQ(surface.vertex(Row(twin)), surface.vertex(Row(0)));
  Vec3 in_face{};
  for (std::size_t c = 0; c < 3; ++c) in_face = in_face + inside.barycentric[c] * mesh.positions[15 + c];
  EXPECT_LT(distance(surface.position(inside), in_face), 1e-15);
  EXPECT_LT(distance(surface.source(inside).position, in_face), 1e-12);
  const Vec3 on_edge = 0.75 * mesh.positions[12] + 0.25 * mesh.positions[13];
  EXPECT_LT(distance(surface.source(EdgePoint{Row(12), Row(13), 0.25}).position, on_edge), 1e-12);
}

TEST(MeshRepair, DropsDegenerateAndDuplicateFaces) {
  Polygons mesh = polygons(icosphere(1));
  const Index sound = mesh.faces();
  const std::vector<Index> first = mesh.face(0), second = mesh.face(1);
  mesh.positions.push_back({std::nan(""), 0, 0});
  mesh.add({0, 1, 1});
  mesh.add({0, 1});
  mesh.add({0, 1, mesh.vertices() - 1});
  mesh.add({second[1], second[0], second[2]});
  mesh.add({first[0], first[0], first[1], first[2], first[0]});
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(repaired.counts, (RepairCounts{.repeated_corners = 1, .degenerate = 2, .not_finite = 1, .duplicates = 2}));
  EXPECT_EQ(repaired.given_face.size(), static_cast<std::size_t>(sound));
  EXPECT_EQ(repaired.remaining(sound - 1), sound - 1);
  EXPECT_EQ(repaired.remaining(sound), std::nullopt);
  EXPECT_EQ(repaired.remaining(-1), std::nullopt);
}

TEST(MeshRepair, RemovesRepeatedCornersOfPolygons) {
  Polygons mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  mesh.add({0, 1, 1, 2, 3});
  mesh.add({1, 4, 5, 2});
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(repaired.counts, RepairCounts{.repeated_corners = 1});
  EXPECT_EQ(surface_of(Polygons{mesh.positions, repaired.face_begin, repaired.face_vertices, {}}).faces().size(), 2U);
}

TEST(MeshRepair, WeldsAChainOnlyWithinTheDistance) {
  Polygons mesh;
  for (int i = 0; i < 40; ++i) mesh.positions.push_back({0.4 * i, 0, 0});
  mesh.positions.push_back({0, 5, 0});
  mesh.add({0, 39, 40});
  const RepairedMesh repaired = repair(mesh, {.weld = 1.0});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Index to = repaired.joined[v];
    EXPECT_LE(distance(mesh.positions[v], mesh.positions[to]), 1.0);
    EXPECT_EQ(repaired.joined[to], to);
  }
  EXPECT_EQ(repaired.joined[2], 0);
  EXPECT_EQ(repaired.joined[3], 3);
}

TEST(MeshRepair, WeldsAtAnyScaleAndDistance) {
  struct Case {
    double scale, weld, noise = 0;
    bool welds = true;
  };
  for (const auto& [scale, weld, noise, welds] :
       {Case{1e-300, 0}, Case{1, 0}, Case{1, 1e-305}, Case{1, 1e-20}, Case{1e300, 0}, Case{1e300, 1e-305},
        Case{1e300, 1e-20}, Case{1, 1e-6, 1e-7}, Case{1, 0, 1e-7, false}}) {
    const Mesh whole = icosphere(2);
    Polygons mesh = torn(whole);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> error(-noise, noise);
    for (Vec3& p : mesh.positions)
      for (double& x : p) x = scale * (x + error(random));
    const RepairedMesh repaired = repair(mesh, {.weld = weld});
    EXPECT_EQ(repaired.counts.welded, welds ? mesh.vertices() - whole.vertices() : 0) << scale << ' ' << weld;
    EXPECT_EQ(repaired.given_face.size(), whole.faces.size());
  }
}

TEST(MeshRepair, OrientsClosedPartsOutward) {
  Polygons mesh = polygons(icosphere(2));
  for (Index f = 0; f < mesh.faces(); ++f)
    if (f % 3 != 0) std::swap(mesh.corners[3 * f + 1], mesh.corners[3 * f + 2]);  // most faces are inward
  const Vec3 center{1e3, -1e3, 1e3};
  for (Vec3& p : mesh.positions) p = p + center;
  const RepairedMesh repaired = repair(mesh, {.orient = true});
  for (std::size_t f = 0; f < repaired.given_face.size(); ++f) {
    const auto face = repaired.faces()[f];
    const Vec3 &a = mesh.positions[face[0]], &b = mesh.positions[face[1]], &c = mesh.positions[face[2]];
    EXPECT_EQ(face[0], mesh.corners[3 * f]);
    EXPECT_GT(dot(cross(b - a, c - a), a - center), 0);
  }
}

TEST(MeshRepair, MakesRandomFacesSoundAndIsIdempotent) {
  std::mt19937 random(11);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  int remaining = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Polygons mesh;
    const int n = 1 + below(12);
    for (int v = 0; v < n; ++v)  // several at the same place, some not finite
      mesh.positions.push_back(below(20) == 0 ? Vec3{std::nan(""), 0, 0}
                                              : Vec3{1.0 * below(3), 1.0 * below(2), 1.0 * below(2)});
    for (int f = 1 + below(15); f > 0; --f) {
      std::vector<Index> face;
      for (int c = below(6); c > 0; --c) face.push_back(below(n));
      mesh.add(face);
    }
    const RepairedMesh repaired = repair(mesh);
    const auto& c = repaired.counts;
    ASSERT_EQ(static_cast<Index>(repaired.given_face.size()) + c.degenerate + c.not_finite + c.duplicates,
              mesh.faces());
    if (repaired.given_face.empty()) continue;
    ++remaining;
    const MeshInspection found = inspect_mesh(n, repaired.faces());
    ASSERT_TRUE(found.outside.empty() && found.small.empty() && found.repeating.empty() && found.duplicates.empty());
    for (Index v : repaired.face_vertices) ASSERT_TRUE(is_finite(mesh.positions[v]) && repaired.joined[v] == v);
    RepairCounts again = repair_mesh(mesh.positions, repaired.faces(), RepairOptions::all()).counts;
    again.welded = 0;  // merged vertices keep their positions
    ASSERT_EQ(again, RepairCounts{}) << trial;
  }
  EXPECT_GT(remaining, 500);
}

TEST(MeshRepair, RefusesInvalidArguments) {
  const Mesh sphere = icosphere(1);
  Polygons mesh = polygons(sphere);
  for (double weld : {-1.0, std::nan("")}) EXPECT_THROW(repair(mesh, {.weld = weld}), InvalidArgument);
  EXPECT_THROW(
      RepairedSurface(std::make_unique<trimesh::TriangleMeshSurface>(surface_of(sphere)), {}, repair(mesh, {})),
      InvalidArgument);
  mesh.add({0, 1, 99});
  EXPECT_THROW(repair(mesh), InvalidGeometry);
}

TEST(MeshRepair, ReportsUnusedButNotMergedVertices) {
  Polygons mesh = torn(icosphere(1));
  mesh.positions.push_back({9, 9, 9});
  const RepairedSurface surface = repaired_surface(mesh);
  const std::vector<Warning> warnings = surface.warnings();
  const auto unused = std::ranges::find(warnings, "unreferenced", &Warning::id);
  ASSERT_NE(unused, warnings.end());
  EXPECT_EQ(unused->numbers[0], 1);
  EXPECT_THROW(surface.vertex(Row(mesh.vertices() - 1)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
