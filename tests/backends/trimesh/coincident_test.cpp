// Vertices may coincide: edges without length are contracted, and the map does not change.
#include "ahm/error.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "thin_meshes.hpp"

namespace ahm::test {
namespace {

TEST(CoincidentVertices, ShareAVertexAndItsNumbers) {
  const Mesh mesh = thin_square(17, {0.0}, 12, true);  // rows from 17 x 17 on: of needles and caps in turn
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().merged_vertices, 12);
  EXPECT_EQ(solved.surface.details().vertices, mesh.vertices() - 12);
  EXPECT_GE(solved.surface.details().dropped_faces, 12);
  EXPECT_EQ(find_warning(solved.surface, "merged").value().numbers[0], 12);
  const RowMap& rows = solved.surface.rows();
  EXPECT_EQ(rows.row_count(), mesh.vertices());
  const RowLogMap map = solved.map(Row(3));
  for (Index row = 17 * 17; row < mesh.vertices(); row += 2) {
    const Index other = rows.row(solved.surface.vertex(Row(row)))->index;
    EXPECT_LT(other, row);
    EXPECT_EQ(mesh.plane[other], mesh.plane[row]);
    EXPECT_EQ(map.u[row], map.u[other]);
    EXPECT_EQ(map.v[row], map.v[other]);
    EXPECT_EQ(map.distance[row], map.distance[other]);
    EXPECT_EQ(map.status[row], Status::ok);
  }
}

TEST(CoincidentVertices, HaveExactTexturesAndSamples) {
  const Mesh mesh = thin_square(17, {0.0, 1e-9}, 8, true);
  const SolvedMesh solved(mesh);
  const LogMap map = solved.solver.solve(solved.surface.source(Row(40), Vec3{2, -1, 2}).source);  // u runs along x
  const std::vector<Vec2> corners = solved.surface.to_corners(map);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int s = 0; s < 3; ++s)
      EXPECT_LT(length(corners[3 * f + s] - (mesh.plane[mesh.faces[f][s]] - mesh.plane[40])), 1e-9) << f;
    const FacePoint point{static_cast<Index>(f), {0.2, 0.5, 0.3}};
    const Sample sample = solved.surface.at(map, point);
    EXPECT_LT(length(Vec2{sample.u, sample.v} - (plane_point(mesh, point) - mesh.plane[40])), 1e-9) << f;
  }
}

/// Splits vertices of a mesh in two at the same place, joined by two faces without area.
Mesh with_doubled_vertices(Mesh mesh, Index count) {
  std::mt19937_64 random(3);
  for (Index k = 0; k < count; ++k) {
    const auto first = static_cast<std::size_t>(random() % mesh.faces.size());
    const Index a = mesh.faces[first][0], m = mesh.vertices();
    mesh.positions.push_back(mesh.positions[a]);
    // One face at a goes to its double, and the next one, if its corners are in the same order.
    const Index c = mesh.faces[first][1];
    Index d = mesh.faces[first][2];
    mesh.faces[first][0] = m;
    const auto next = std::ranges::find_if(mesh.faces, [&](const Triangle& t) {
      return (t[0] == a && t[1] == d) || (t[1] == a && t[2] == d) || (t[2] == a && t[0] == d);
    });
    if (next != mesh.faces.end() && std::ranges::find(*next, c) == next->end()) {
      const Index e = (*next)[0] + (*next)[1] + (*next)[2] - a - d;
      *std::ranges::find(*next, a) = m;
      d = e;
    }
    mesh.faces.push_back({a, c, m});
    mesh.faces.push_back({m, d, a});
  }
  return mesh;
}

TEST(CoincidentVertices, OfCurvedMeshesChangeNothing) {
  for (const Mesh& clean : {torus(900), icosphere(9), moebius_mesh(40, 8)}) {
    const Mesh doubled = with_doubled_vertices(clean, 40);
    const SolvedMesh a(clean), b(doubled);
    const auto &details = b.surface.details(), &expected = a.surface.details();
    EXPECT_EQ(details.merged_vertices, 40);
    EXPECT_EQ(details.dropped_faces, 80);
    EXPECT_EQ(details.vertices, clean.vertices());
    EXPECT_EQ(details.topology.euler_characteristic, expected.topology.euler_characteristic);
    EXPECT_EQ(details.topology.boundary_edges, expected.topology.boundary_edges);
    for (Index source : {0, 77, 200})
      for (Variant variant : all_variants) {
        const Vec3 axis{0.3, 0.5, 0.7};
        const RowLogMap p = a.map(Row(source), axis, variant), q = b.map(Row(source), axis, variant);
        for (Index i = 0; i < clean.vertices(); ++i) {
          ASSERT_EQ(q.status[i], p.status[i]);
          ASSERT_NEAR(q.u[i], p.u[i], 1e-10) << i;
          ASSERT_NEAR(std::abs(q.v[i]), std::abs(p.v[i]), 1e-10) << i;
          ASSERT_NEAR(q.distance[i], p.distance[i], 1e-10) << i;
        }
        for (Index i = clean.vertices(); i < doubled.vertices(); ++i) ASSERT_EQ(q.status[i], Status::ok);
      }
    const auto exact = [](const SolvedMesh& mesh, const SurfacePoint& point) {
      return mesh.surface.to_rows(exact_log_map(mesh.surface, point)).distance;
    };
    // A point of a dropped face is a point of the edge that the face became.
    const auto dropped = static_cast<Index>(doubled.faces.size()) - 1;
    const auto [m, d, at] = doubled.faces[dropped];
    const auto on_edge = exact(b, EdgePoint{Row(at), Row(d), 0.6});
    expect_near(exact(b, Row(5)), exact(a, Row(5)), 1e-12);
    expect_near(exact(b, FacePoint{dropped, {0.1, 0.6, 0.3}}), std::span(on_edge).first(a.surface.positions().size()),
                1e-12);
  }
}

TEST(CoincidentVertices, NeedNoPositions) {
  const Mesh clean = torus(600);
  const auto a = TriangleMeshSurface::build(without_positions(clean)),
             b = TriangleMeshSurface::build(without_positions(with_doubled_vertices(clean, 20)));
  EXPECT_EQ(b.details().merged_vertices, 20);
  expect_near(map_of(b, Row(9)).distance, map_of(a, Row(9)).distance, 1e-10);
}

TEST(CoincidentVertices, HaveDistanceZeroFromEachOther) {
  for (const double apart : {0.0, 1e-14, 1e-13, 1e-12}) {
    Mesh mesh = flat_square(11);
    const auto& [a, b, c] = mesh.faces[103];
    mesh.positions[b] = mesh.positions[a] + Vec3{apart, 0, 0};
    const SolvedMesh solved(mesh);
    for (const auto& [source, other] : {std::pair{a, b}, {b, a}}) {
      const RowLogMap map = solved.map(Row(source));
      EXPECT_EQ(map.distance[source], 0) << apart;
      EXPECT_NEAR(map.distance[other], apart, 2e-12);
    }
  }
}

TEST(CoincidentVertices, MayBeAllOfAFace) {
  // A face that shrank to a point, and its neighbors to lines.
  Mesh mesh = flat_square(11);
  const Triangle t = mesh.faces[103];
  const Vec2 at = mesh.plane[t[0]];
  for (Index v : t) mesh.plane[v] = at, mesh.positions[v] = {at[0], at[1], 0};
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().merged_vertices, 2);
  EXPECT_EQ(solved.surface.details().dropped_faces, 4);
  const RowLogMap map = solved.map(FacePoint{103, {0.2, 0.3, 0.5}});
  for (Index v : t) EXPECT_NEAR(map.distance[v], 0, 1e-12);
  EXPECT_EQ(std::ranges::count(map.status, Status::ok), mesh.vertices());
}

TEST(CoincidentVertices, RemoveAComponentWithoutArea) {
  Mesh mesh = icosphere(4);
  const Index n = mesh.vertices();
  for (const Vec3& p : {Vec3{3, 0, 0}, Vec3{3, 0, 0}, Vec3{4, 0, 0}}) mesh.positions.push_back(p);
  mesh.faces.push_back({n, n + 1, n + 2});
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().topology.components, 1);
  EXPECT_EQ(solved.surface.details().dropped_faces, 1);
  const RowLogMap map = solved.map(Row(0));
  for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_EQ(map.status[i], i < n ? Status::ok : Status::removed);
  EXPECT_THROW(solved.surface.source(FacePoint{static_cast<Index>(mesh.faces.size()) - 1, {0.2, 0.3, 0.5}}),
               InvalidArgument);
}

TEST(CoincidentVertices, JoinedByNoEdgeLeaveThePlaneExact) {
  // Two vertices at the middle of one edge, each in a face without height on one of its sides.
  const Mesh mesh = at_plane(
      {{},
       {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 5}, {4, 2, 8}, {2, 5, 8}, {3, 0, 6}, {1, 3, 7}, {3, 6, 9}, {7, 3, 9}},
       {{0, 0}, {1, 0}, {0.5, 0}, {0.5, 0}, {0, 1}, {1, 1}, {0, -1}, {1, -1}, {0.5, 0.9}, {0.4, -0.8}}});
  for (bool flips : {true, false}) {
    const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
    EXPECT_EQ(solved.surface.details().mollification, 0);
    for (Index source : {2, 3, 4})
      EXPECT_LT(PlaneErrors(mesh, solved.map(Row(source)), mesh.plane[source]).coordinates, 1e-11) << source;
  }
}

TEST(CoincidentVertices, RemoveFacesThatAreAttachedByALine) {
  // An ear at the boundary whose base has no length.
  Mesh mesh = flat_square(7);
  const Index n = mesh.vertices();
  ASSERT_EQ(mesh.faces[0][0], 0);  // side 0-1 is on the boundary
  mesh.plane[1] = mesh.plane[0];
  mesh.plane.push_back({0, -1});
  mesh.faces.push_back({1, 0, n});
  const SolvedMesh solved(at_plane(mesh));
  const LogMap map = solved.solver.solve(solved.surface.source(Row(20)).source);
  const RowLogMap rows = solved.surface.to_rows(map);
  EXPECT_EQ(rows.status[n], Status::removed);
  EXPECT_EQ(rows.status[0], Status::ok);
  EXPECT_EQ(rows.distance[0], rows.distance[1]);
  EXPECT_EQ(solved.surface.to_corners(map).size(), 3 * mesh.faces.size());
  try {
    solved.surface.source(Row(n));
    ADD_FAILURE() << "a source at a row without a vertex";
  } catch (const InvalidArgument& e) {
    EXPECT_EQ(e.fault(), "row_without_area");
  }
}

TEST(CoincidentVertices, SplitAMeshWhereItIsAPointWide) {
  // Two squares joined by two faces at an edge without length.
  const SolvedMesh solved(Mesh{{{0, 1, 0}, {0, 1, 0}, {-2, 0, 0}, {-2, 2, 0}, {2, 0, 0}, {2, 2, 0}},
                               {{2, 0, 1}, {2, 1, 3}, {0, 4, 1}, {4, 5, 1}},
                               {}});
  EXPECT_EQ(solved.surface.details().topology.components, 2);
  const RowLogMap map = solved.map(Row(2));
  for (Index row : {0, 1}) {
    EXPECT_EQ(solved.surface.rows().vertices(Row(row)).size(), 2);
    EXPECT_EQ(map.status[row], Status::ok);
  }
  EXPECT_EQ(map.status[4], Status::disconnected);
}

}  // namespace
}  // namespace ahm::test
