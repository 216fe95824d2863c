// What a bad polygon mesh gets: an error that names the culprit, or a result with a status per vertex.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "polygon_graphs.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

using polymesh::PolygonOptions;

template <class Exception>
void expect_error(const Polygons& mesh, const std::string& text, const PolygonOptions& options = {}) {
  test::expect_error<Exception>([&] { build(mesh, options); }, text);
}

LogMap map_of(const polymesh::PolygonMeshSurface& surface, Index source = 0) {
  return LogMapSolver(surface.graph()).solve(surface.source(Row(source)).source);
}

TEST(PolygonFaults, NothingThere) {
  expect_error<InvalidGeometry>({}, "no vertices");
  expect_error<InvalidGeometry>({{{0, 0, 0}}, {0}, {}, {}}, "no faces");
}

TEST(PolygonFaults, BadFaces) {
  Polygons mesh = cube_sphere(2);
  mesh.corners[4 * 7 + 1] = mesh.vertices();
  expect_error<InvalidGeometry>(mesh, "face 7");
  mesh.corners[4 * 7 + 1] = -1;
  expect_error<InvalidGeometry>(mesh, "outside [0, 26)");
  mesh.corners[4 * 7 + 1] = mesh.corners[4 * 7 + 3];
  expect_error<InvalidGeometry>(mesh, "use a vertex twice: face 7");
  mesh = cube_sphere(2);
  mesh.add({0, 1});
  expect_error<InvalidGeometry>(mesh, "fewer than 3 corners: face 24 (0, 1)");
  mesh = cube_sphere(2);
  mesh.begin.back() -= 1;
  expect_error<InvalidGeometry>(mesh, "face_begin");
}

TEST(PolygonFaults, DuplicateFaces) {
  Polygons mesh = cube_sphere(2);
  auto face = mesh.face(3);
  std::rotate(face.begin(), face.begin() + 2, face.end());
  mesh.add(face);
  expect_error<InvalidGeometry>(mesh, "1 faces have a duplicate: face 24 repeats face 3");
  mesh.reverse(24);
  expect_error<InvalidGeometry>(mesh, "face 24 repeats face 3");
}

TEST(PolygonFaults, FacesThatShareAllVerticesInAnotherOrderAreNoDuplicates) {
  // Two quads over the same four points, crossing: each edge has two faces, or one.
  const Polygons mesh{{{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}}, {0, 4, 8}, {0, 1, 2, 3, 0, 2, 1, 3}, {}};
  EXPECT_NO_THROW(map_of(build(mesh, {.non_manifold = NonManifold::split})));
}

TEST(PolygonFaults, CoordinatesThatAreNotFinite) {
  Polygons mesh = cube_sphere(2);
  mesh.positions[5][1] = NAN;
  expect_error<InvalidGeometry>(mesh, "vertex 5");
}

TEST(PolygonFaults, EdgesOfThreeFacesAndBowTies) {
  Polygons fin = quad_grid(3);
  fin.positions.push_back({0, 0, 9});
  fin.positions.push_back({1, 0, 9});
  fin.add({5, 6, fin.vertices() - 1, fin.vertices() - 2});
  expect_error<InvalidGeometry>(fin, "1 edges have more than two faces: (5, 6) with 3 faces");
  const auto split = build(fin, {.non_manifold = NonManifold::split});
  EXPECT_EQ(split.details().topology.non_manifold_edges, 1);
  EXPECT_NO_THROW(validate(split.graph()));
  const auto rows = split.to_rows(map_of(split));
  EXPECT_EQ(rows.status.size(), fin.positions.size());

  const Polygons bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}},
                     {0, 4, 8},
                     {0, 1, 2, 3, 0, 4, 5, 6},
                     {}};
  expect_error<InvalidGeometry>(bow, "1 vertices join several fans of faces (bow ties): 0");
  EXPECT_EQ(build(bow, {.non_manifold = NonManifold::split}).details().topology.components, 2);
}

TEST(PolygonFaults, UnreferencedVerticesAndOtherComponentsAreMasked) {
  Polygons mesh = quad_grid(8);
  const Index n = mesh.vertices();
  mesh.positions.push_back({1e6, 8, 7});  // far away, and no vertex of a face
  for (const Vec3& p : {Vec3{5, 5, 5}, Vec3{6, 5, 5}, Vec3{6, 6, 5}, Vec3{5, 6, 5}}) mesh.positions.push_back(p);
  mesh.add({n + 1, n + 2, n + 3, n + 4});
  const auto surface = build(mesh);
  EXPECT_EQ(surface.details().topology.components, 2);
  EXPECT_EQ(surface.details().topology.unreferenced, 1);
  const auto rows = surface.to_rows(map_of(surface));
  EXPECT_EQ(rows.status[n], Status::removed);
  EXPECT_EQ(rows.status[n + 1], Status::disconnected);
  for (Index i = 0; i < n; ++i) ASSERT_EQ(rows.status[i], Status::ok);
  EXPECT_THROW(surface.source(Row(n)), InvalidArgument);
}

TEST(PolygonFaults, MoebiusBandsAreSolvedWithReflections) {
  const Polygons mesh = moebius_quads(60, 6);
  const auto surface = build(mesh);
  EXPECT_FALSE(surface.details().topology.orientable);
  EXPECT_EQ(surface.details().topology.boundary_loops, 1);
  EXPECT_EQ(surface.graph().transport_kind(), TransportKind::block);
  EXPECT_NO_THROW(validate(surface.graph()));
  const LogMap map = map_of(surface, 3);
  EXPECT_EQ(map.count(Status::ok), mesh.vertices());
  const auto refined = surface.mesh().refined();
  const auto triangles = trimesh::TriangleMeshSurface::build(refined.positions, refined.triangles);
  const LogMap other = LogMapSolver(triangles.graph()).solve(triangles.source(Row(3)).source);
  const double h = surface.graph().mean_edge_length() * surface.graph().length_unit();
  for (Index i = 0; i < mesh.vertices(); ++i)
    if (other.distance(Vertex(i)) < 1.5)
      EXPECT_NEAR(map.distance(Vertex(i)), other.distance(Vertex(i)), h) << "vertex " << i;
}

TEST(PolygonFaults, EveryWarningComesOnceHoweverItIsDiscretized) {
  Polygons mesh = moebius_quads(60, 6);
  mesh.reverse(7);
  mesh.positions.push_back({0, 0, 0});  // no vertex of a face
  for (const auto discretization : {polymesh::Discretization::polygons, polymesh::Discretization::refined}) {
    const auto surface = polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                                             {.discretization = discretization});
    std::multiset<std::string_view> ids;
    for (const Warning& warning : surface.warnings()) ids.insert(warning.id);
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
  const LogMap map = map_of(surface);
  EXPECT_EQ(map.count(Status::ok) + map.count(Status::disconnected), surface.graph().size());
  EXPECT_GT(map.count(Status::ok), mesh.vertices() - 5);
  Polygons point = quad_grid(2);
  for (Vec3& p : point.positions) p = {1, 2, 3};
  expect_error<InvalidGeometry>(point, "same place");
}

TEST(PolygonFaults, AnyScaleAndAnyPlace) {
  const Polygons mesh = voronoi_square(60);
  for (double scale : {1e-300, 1e-12, 1e12, 1e300}) {
    Polygons other = mesh;
    for (Vec3& p : other.positions)
      for (double& x : p) x *= scale;
    for (auto& p : other.plane)
      for (double& x : p) x *= scale;
    const auto surface = build(other);
    const auto map = surface.to_rows(map_of(surface, 9));
    for (Index i = 0; i < mesh.vertices(); ++i) {
      const double exact = std::hypot(mesh.plane[i][0] - mesh.plane[9][0], mesh.plane[i][1] - mesh.plane[9][1]);
      ASSERT_NEAR(map.distance[i] / scale, exact, 1e-11) << scale;
    }
  }
  Polygons far = mesh;
  for (Vec3& p : far.positions) p[0] += 1e6, p[1] -= 1e6;
  const auto surface = build(far);
  const auto map = surface.to_rows(map_of(surface, 9));
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double exact = std::hypot(mesh.plane[i][0] - mesh.plane[9][0], mesh.plane[i][1] - mesh.plane[9][1]);
    ASSERT_NEAR(map.distance[i], exact, 1e-8);  // the input has ten digits left
  }
}

TEST(PolygonFaults, SourcesThatAreNotThere) {
  const Polygons mesh = cube_sphere(3);
  const auto surface = build(mesh);
  EXPECT_THROW(surface.source(Row(-1)), InvalidArgument);
  EXPECT_THROW(surface.source(Row(mesh.vertices())), InvalidArgument);
  EXPECT_THROW(surface.source(Row(0), Vec3{0, 0, 0}), InvalidArgument);
  EXPECT_THROW(surface.source(Row(0), mesh.positions[0]), InvalidArgument);  // along the normal
  const std::vector<double> mean(4, 0.25);
  EXPECT_THROW(surface.source(FacePoint{-1, mean}), InvalidArgument);
  EXPECT_THROW(surface.source(FacePoint{mesh.faces(), mean}), InvalidArgument);
  const std::vector<double> three{0.5, 0.25, 0.25}, more{0.5, 0.5, 0.5, 0}, negative{0.5, 0.7, -0.2, 0},
      bad{NAN, 0.5, 0.5, 0};
  for (const auto& weights : {three, more, negative, bad})
    EXPECT_THROW(surface.source(FacePoint{0, weights}), InvalidArgument);
}

TEST(PolygonFaults, CanBeStopped) {
  const Polygons mesh = cube_sphere(8);
  std::stop_source stop;
  stop.request_stop();
  PolygonOptions options;
  options.progress.stop = stop.get_token();
  EXPECT_THROW(build(mesh, options), Cancelled);
}

TEST(PolygonSymmetry, RepeatsBitForBitOnAnyNumberOfThreads) {
  const Polygons mesh = voronoi_sphere(3000);
  const auto one = build(mesh, {.threads = 1}), many = build(mesh, {.threads = 4});
  EXPECT_EQ(one.graph().data().weights, many.graph().data().weights);
  EXPECT_EQ(one.graph().data().logs, many.graph().data().logs);
  EXPECT_EQ(one.graph().data().transports, many.graph().data().transports);
}

}  // namespace
}  // namespace ahm::test
