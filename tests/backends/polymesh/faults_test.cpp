// A bad polygon mesh leads to an error that names the fault, or to a map with a status per row. Faults that are found by the
// code that triangle meshes use, too, are in ../trimesh/faults_test.cpp.
#include <functional>
#include <set>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "polygon_graphs.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

void add_rotated_face(Polygons& mesh) {
  const std::vector<Index> face = mesh.face(3);
  mesh.add({face[2], face[3], face[0], face[1]});
}

TEST(PolygonFaults, AreNamed) {
  const std::pair<const char*, void (*)(Polygons&)> cases[] = {
      {"no vertices", [](Polygons& mesh) { mesh = {}; }},
      {"vertex 5", [](Polygons& mesh) { mesh.positions[5][1] = NAN; }},
      {"same place",
       [](Polygons& mesh) {
         std::ranges::fill(mesh.positions, Vec3{1, 2, 3});
       }},
      {"face 7", [](Polygons& mesh) { mesh.corners[4 * 7 + 1] = mesh.corners[4 * 7 + 3]; }},
      {"fewer than 3 corners: face 24 (0, 1)",
       [](Polygons& mesh) {
         mesh.add({0, 1});
       }},
      {"face_begin", [](Polygons& mesh) { mesh.begin.back() -= 1; }},
      {"face 24 repeats face 3", add_rotated_face},
      {"face 24 repeats face 3", [](Polygons& mesh) { add_rotated_face(mesh), mesh.reverse(24); }},
  };
  for (const auto& [text, damage] : cases) {
    Polygons mesh = cube_sphere(2);
    damage(mesh);
    expect_error<InvalidGeometry>([&] { build(mesh); }, text);
  }
  std::stop_source stop;
  stop.request_stop();
  PolygonOptions stopped;
  stopped.progress.stop = stop.get_token();
  EXPECT_THROW(build(cube_sphere(8), stopped), Cancelled);
}

TEST(PolygonFaults, AFacePointNeedsAWeightForEachCorner) {
  const auto surface = build(cube_sphere(3));
  EXPECT_THROW(surface.source(FacePoint{0, {0.5, 0.25, 0.25}}), InvalidArgument);
  EXPECT_NO_THROW(surface.source(FacePoint{0, {0.5, 0.25, 0.25, 0}}));
}

TEST(PolygonFaults, MeshesThatAreNoManifoldsAreSplit) {
  Polygons fin = quad_grid(3);
  fin.positions.push_back({0, 0, 9});
  fin.positions.push_back({1, 0, 9});
  fin.add({5, 6, fin.vertices() - 1, fin.vertices() - 2});
  EXPECT_THROW(build(fin), InvalidGeometry);
  EXPECT_EQ(build(fin, {.non_manifold = NonManifold::split}).details().topology.non_manifold_edges, 1);
  // Two quads with the same four vertices in another order are no duplicates.
  const Polygons crossing{{{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}}, {0, 4, 8}, {0, 1, 2, 3, 0, 2, 1, 3}, {}};
  for (const Polygons& mesh : {fin, crossing}) {
    const auto surface = build(mesh, {.non_manifold = NonManifold::split});
    EXPECT_NO_THROW(validate(surface.graph()));
    EXPECT_EQ(map_of(surface, Row(0)).status.size(), mesh.positions.size());
  }
}

TEST(PolygonFaults, UnreferencedVerticesAndOtherComponentsAreMasked) {
  Polygons mesh = quad_grid(8);
  const Index n = mesh.vertices();
  for (const Vec3& p : {Vec3{1e6, 8, 7}, {5, 5, 5}, {6, 5, 5}, {6, 6, 5}, {5, 6, 5}}) mesh.positions.push_back(p);
  mesh.add({n + 1, n + 2, n + 3, n + 4});
  const auto surface = build(mesh);
  EXPECT_EQ(surface.details().topology.components, 2);
  EXPECT_EQ(surface.details().topology.unreferenced, 1);
  const RowLogMap map = map_of(surface, Row(0));
  for (Index i = 0; i < n + 5; ++i)
    ASSERT_EQ(map.status[i], i < n ? Status::ok : i == n ? Status::removed : Status::disconnected);
  EXPECT_THROW(surface.source(Row(n)), InvalidArgument);
}

TEST(PolygonFaults, MoebiusBandsAreSolvedWithReflections) {
  const Polygons mesh = moebius_quads(60, 6);
  const auto surface = build(mesh);
  EXPECT_FALSE(surface.details().topology.orientable);
  EXPECT_EQ(surface.details().topology.boundary_loops, 1);
  EXPECT_EQ(surface.graph().transport_kind(), TransportKind::block);
  EXPECT_NO_THROW(validate(surface.graph()));
  const RowLogMap map = map_of(surface, Row(3)), other = map_of(build(mesh, Discretization::refined), Row(3));
  EXPECT_EQ(std::ranges::count(map.status, Status::ok), mesh.vertices());
  for (Index i = 0; i < mesh.vertices(); ++i)
    if (other.distance[i] < 1.5) EXPECT_NEAR(map.distance[i], other.distance[i], mean_edge(surface)) << "vertex " << i;
}

TEST(PolygonFaults, EveryWarningComesOnceInBothDiscretizations) {
  Polygons mesh = moebius_quads(60, 6);
  mesh.reverse(7);
  mesh.positions.push_back({0, 0, 0});  // no vertex of a face
  for (const auto discretization : {Discretization::polygons, Discretization::refined}) {
    std::multiset<std::string_view> ids;
    for (const Warning& warning : build(mesh, discretization).warnings()) ids.insert(warning.id);
    EXPECT_EQ(ids, (std::multiset<std::string_view>{"not_orientable", "reoriented", "unreferenced"}));
  }
}

TEST(PolygonFaults, FacesWithoutAreaAreMapped) {
  Polygons mesh = quad_grid(10);
  // A face of coincident corners, one of collinear ones, and a needle.
  for (Index v : {12, 13}) mesh.positions[v] = mesh.positions[24];
  mesh.positions[60] = mesh.positions[61];
  const auto surface = build(mesh);
  EXPECT_NO_THROW(validate(surface.graph()));
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(0)).source);
  EXPECT_EQ(map.count(Status::ok) + map.count(Status::disconnected), surface.graph().size());
  EXPECT_GT(map.count(Status::ok), mesh.vertices() - 5);
}

TEST(PolygonSymmetry, TheMapScalesAndMoves) {
  const Polygons mesh = voronoi_square(60);
  const auto map_after = [&](double scale, const Vec3& shift) {
    Polygons other = mesh;
    for (Vec3& p : other.positions) p = scale * p + shift;
    return scaled(1 / scale, map_of(build(other), Row(9)));
  };
  for (double scale : {1e-300, 1e-12, 1e12, 1e300})
    expect_plane_distances(map_after(scale, {0, 0, 0}), mesh.plane, 9, 1e-11);
  expect_plane_distances(map_after(1, {1e6, -1e6, 0}), mesh.plane, 9, 1e-8);  // the input has ten digits left
}

TEST(PolygonSymmetry, DoesNotDependOnTheNumberOfThreads) {
  const Polygons mesh = voronoi_sphere(3000);
  expect_same_bits(build(mesh, {.threads = 1}), build(mesh, {.threads = 4}));
}

TEST(PolygonSymmetry, AComponentHasTheSameNumbersNextToOthers) {
  const Polygons quads = cube_sphere(7), cells = voronoi_sphere(100), triangles = quad_grid(12, true);
  for (const auto& [a, b] : {std::pair{quads, cells}, {cells, quads}, {cells, triangles}, {triangles, cells}})
    for (Discretization how : {Discretization::polygons, Discretization::refined}) {
      const RowLogMap alone = map_of(build(a, how), Row(5));
      for (double scale : {0.03, 30.0, 1e6}) {
        Polygons both = a;
        for (const Vec3& p : b.positions) both.positions.push_back(scale * p + Vec3{3 + scale, 0, 0});
        for (Index f = 0; f < b.faces(); ++f) {
          std::vector<Index> face = b.face(f);
          for (Index& v : face) v += a.vertices();
          both.add(face);
        }
        const RowLogMap together = map_of(build(both, how), Row(5));
        SCOPED_TRACE(scale);
        expect_same_rows(alone, together, 1e-10, std::identity{});
        expect_near(together.spread, alone.spread, 1e-5);
      }
    }
}

}  // namespace
}  // namespace ahm::test
