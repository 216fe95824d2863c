// Faces may be as thin as they like, and vertices may coincide: the map does not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "support/solved_mesh.hpp"
#include "thin_meshes.hpp"

namespace ahm::test {
namespace {

using trimesh::TriangleMesh;
using trimesh::TriangleMeshSurface;

/// Largest error of coordinates, and of distances, against the plane; the u axis is read off at the farthest vertex.
/// Infinite unless all is mapped.
struct PlaneErrors {
  double coordinates, distance = 0;

  PlaneErrors(const Mesh& mesh, const RowLogMap& map, const Vec2& origin) {
    auto away = [&](std::size_t i) { return std::hypot(mesh.plane[i][0] - origin[0], mesh.plane[i][1] - origin[1]); };
    std::size_t far = 0;
    for (std::size_t i = 0; i < mesh.plane.size(); ++i) {
      if (away(i) > away(far)) far = i;
      const double off = std::abs(map.distance[i] - away(i));
      distance = std::isnan(off) || map.status[i] != Status::ok ? INFINITY : std::max(distance, off);
    }
    const double x = mesh.plane[far][0] - origin[0], y = mesh.plane[far][1] - origin[1], r = std::hypot(x, y),
                 s = std::hypot(map.u[far], map.v[far]);
    coordinates = plane_error(
        mesh, map, origin, {(x * map.u[far] + y * map.v[far]) / (r * s), (y * map.u[far] - x * map.v[far]) / (r * s)});
  }
};

/// From rows, faces and edges, the thin ones among them.
struct Place {
  std::string name;
  SurfacePoint point;
  Vec2 plane;
};

std::vector<Place> places(const Mesh& mesh) {
  std::vector<Place> result;
  const Index n = mesh.vertices(), faces = static_cast<Index>(mesh.faces.size());
  for (Index v : {0, n / 3, n - 1, n - 2, n - 7}) result.push_back({"row " + std::to_string(v), Row(v), mesh.plane[v]});
  for (Index f : {7, faces / 2, faces - 1, faces - 2, faces - 12, faces - 13}) {
    result.push_back(
        {"face " + std::to_string(f), FacePoint{f, {0.3, 0.5, 0.2}}, mesh.plane_point(f, {0.3, 0.5, 0.2})});
    for (int s = 0; s < 3; ++s) {
      Vec3 weights{0, 0, 0};
      weights[s] = 0.7;
      weights[(s + 1) % 3] = 0.3;
      result.push_back({"edge of face " + std::to_string(f),
                        EdgePoint{Row(mesh.faces[f][s]), Row(mesh.faces[f][(s + 1) % 3]), 0.3},
                        mesh.plane_point(f, weights)});
    }
  }
  return result;
}

void expect_identity(const Mesh& mesh, bool flips, const std::string& name) {
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = flips});
  EXPECT_EQ(surface.details().mollification, 0) << name;
  EXPECT_FALSE(surface.details().flips_stopped) << name;
  EXPECT_NO_THROW(validate(surface.graph())) << name;
  const LogMapSolver solver(surface.graph());
  for (Variant variant : all_variants)
    for (const auto& [where, point, plane] : places(mesh)) {
      const LogMap map = solver.solve(surface.source(point).source, {.variant = variant});
      const PlaneErrors errors(mesh, surface.to_rows(map), plane);
      EXPECT_LT(errors.coordinates, 1e-9 * mesh.diameter()) << name << ", " << where;
      EXPECT_LT(errors.distance, 1e-9 * mesh.diameter()) << name << ", " << where;
      // Fronts expect no errors where they cross triangles that flips made; across others they are rougher.
      if (surface.graph().is_delaunay()) {
        EXPECT_GT(std::ranges::min(map_quality(surface.graph(), map)), 0.9) << name << ", " << where;
      }
    }
}

TEST(ThinFaces, LeaveThePlaneExact) {
  for (bool tilted : {false, true})
    for (double thinness : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0})
      expect_identity(thin_square(17, {thinness}, 12, tilted), true,
                      "thinness " + std::to_string(std::log10(thinness)) + (tilted ? ", tilted" : ""));
}

TEST(ThinFaces, OfAllDegreesLeaveThePlaneExact) {
  for (bool tilted : {false, true})
    for (bool flips : {true, false})
      for (unsigned seed : {1u, 2u})
        expect_identity(thin_square(19, {1e-3, 1e-5, 1e-7, 1e-9, 1e-10, 3e-11, 1e-11, 1e-12, 0.0}, 4, tilted, seed),
                        flips, std::string("all degrees") + (tilted ? ", tilted" : "") + (flips ? "" : ", no flips"));
}

TEST(ThinFaces, LeaveThePlaneExactFarFromTheOrigin) {
  Mesh mesh = thin_square(15, {1e-5, 0.0}, 8, true);
  for (Vec3& p : mesh.positions)
    for (double& x : p) x = 1e-3 * x + 4;  // rounding is 1e-12 of the mesh
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  EXPECT_EQ(surface.details().mollification, 0);
  const LogMapSolver solver(surface.graph());
  for (const auto& [where, point, plane] : places(mesh)) {
    RowLogMap map = surface.to_rows(solver.solve(surface.source(point).source));
    for (auto* numbers : {&map.u, &map.v, &map.distance})
      for (double& x : *numbers) x *= 1e3;
    EXPECT_LT(PlaneErrors(mesh, map, plane).coordinates, 1e-6) << where;
  }
}

TEST(CoincidentVertices, ShareAVertexAndItsNumbers) {
  const Mesh mesh = thin_square(17, {0.0}, 12, true);  // rows from 17 x 17 on: a needle's, a cap's, a needle's, ...
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().merged_vertices, 12);
  EXPECT_EQ(solved.surface.details().vertices, mesh.vertices() - 12);
  EXPECT_GE(solved.surface.details().dropped_faces, 12);
  const auto warnings = solved.surface.warnings();
  const auto merged = std::ranges::find(warnings, "merged", &Warning::id);
  ASSERT_NE(merged, warnings.end());
  EXPECT_EQ(merged->numbers[0], 12);
  const RowMap& rows = solved.surface.rows();
  EXPECT_EQ(rows.row_count(), mesh.vertices());
  const RowLogMap map = solved.map(solved.surface.source(Row(3)).source);
  for (Index row = 17 * 17; row < mesh.vertices(); row += 2) {
    const Vertex vertex = solved.surface.vertex(Row(row));
    const Row other = *rows.row(vertex);
    EXPECT_LT(other.index, row);
    EXPECT_EQ(mesh.plane[other.index], mesh.plane[row]);
    EXPECT_EQ(map.u[row], map.u[other.index]);
    EXPECT_EQ(map.v[row], map.v[other.index]);
    EXPECT_EQ(map.distance[row], map.distance[other.index]);
    EXPECT_EQ(map.status[row], Status::ok);
  }
}

TEST(CoincidentVertices, KeepTexturesAndSamples) {
  const Mesh mesh = thin_square(17, {0.0, 1e-9}, 8, true);
  const SolvedMesh solved(mesh);
  const LogMap map = solved.solver.solve(solved.surface.source(Row(40), Vec3{2, -1, 2}).source);  // u runs along x
  const std::vector<Vec2> corners = solved.surface.to_corners(map);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int s = 0; s < 3; ++s) {
      const Vec2 p = mesh.plane[mesh.faces[f][s]], o = mesh.plane[40];
      EXPECT_NEAR(corners[3 * f + s][0], p[0] - o[0], 1e-9) << f;
      EXPECT_NEAR(corners[3 * f + s][1], p[1] - o[1], 1e-9) << f;
    }
    const Vec2 p = mesh.plane_point(static_cast<Index>(f), {0.2, 0.5, 0.3}), o = mesh.plane[40];
    const Sample sample = solved.surface.at(map, FacePoint{static_cast<Index>(f), {0.2, 0.5, 0.3}});
    EXPECT_NEAR(sample.u, p[0] - o[0], 1e-9) << f;
    EXPECT_NEAR(sample.v, p[1] - o[1], 1e-9) << f;
  }
}

/// Splits vertices of a mesh in two at the same place, joined by two faces without area.
Mesh with_doubled_vertices(Mesh mesh, Index count, unsigned seed) {
  std::mt19937_64 random(seed);
  for (Index k = 0; k < count; ++k) {
    const auto first = static_cast<std::size_t>(random() % mesh.faces.size());
    const Index a = mesh.faces[first][0], m = mesh.vertices();
    mesh.positions.push_back(mesh.positions[a]);
    // One face about a goes to its double, and the next one, where its corners are found in the same order.
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
    const Mesh doubled = with_doubled_vertices(clean, 40, 3);
    const SolvedMesh a(clean), b(doubled);
    EXPECT_EQ(b.surface.details().merged_vertices, 40);
    EXPECT_EQ(b.surface.details().dropped_faces, 80);
    EXPECT_EQ(b.surface.details().vertices, clean.vertices());
    EXPECT_EQ(b.surface.details().topology.euler_characteristic, a.surface.details().topology.euler_characteristic);
    EXPECT_EQ(b.surface.details().topology.boundary_edges, a.surface.details().topology.boundary_edges);
    for (Index source : {0, 77, 200})
      for (Variant variant : all_variants) {
        const Vec3 axis{0.3, 0.5, 0.7};
        const RowLogMap p = a.map(a.surface.source(Row(source), axis).source, variant),
                        q = b.map(b.surface.source(Row(source), axis).source, variant);
        for (Index i = 0; i < clean.vertices(); ++i) {
          ASSERT_EQ(q.status[i], p.status[i]);
          ASSERT_NEAR(q.u[i], p.u[i], 1e-10) << i;
          ASSERT_NEAR(std::abs(q.v[i]), std::abs(p.v[i]), 1e-10) << i;
          ASSERT_NEAR(q.distance[i], p.distance[i], 1e-10) << i;
        }
        for (Index i = clean.vertices(); i < doubled.vertices(); ++i) ASSERT_EQ(q.status[i], Status::ok);
      }
    const LogMap exact = exact_log_map(a.surface, Row(5)), other = exact_log_map(b.surface, Row(5));
    for (Index i = 0; i < clean.vertices(); ++i)
      ASSERT_NEAR(other.distance(b.surface.vertex(Row(i))), exact.distance(a.surface.vertex(Row(i))), 1e-12);
    // In a face that was dropped, the point is one of the edge it became.
    const Index dropped = static_cast<Index>(doubled.faces.size()) - 1;
    const auto [m, d, at] = doubled.faces[dropped];
    const RowLogMap inside = b.surface.to_rows(exact_log_map(b.surface, FacePoint{dropped, {0.1, 0.6, 0.3}})),
                    on_edge = b.surface.to_rows(exact_log_map(b.surface, EdgePoint{Row(at), Row(d), 0.6}));
    for (Index i = 0; i < clean.vertices(); ++i) ASSERT_NEAR(inside.distance[i], on_edge.distance[i], 1e-12);
  }
}

TEST(CoincidentVertices, NeedNoPositions) {
  const Mesh clean = torus(600), doubled = with_doubled_vertices(clean, 20, 3);
  auto surface_of = [](const Mesh& mesh) {
    std::vector<std::array<double, 3>> lengths;
    for (const Triangle& t : mesh.faces) {
      lengths.emplace_back();
      for (int s = 0; s < 3; ++s) {
        const Vec3 &p = mesh.positions[t[s]], &q = mesh.positions[t[(s + 1) % 3]];
        lengths.back()[s] = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      }
    }
    return TriangleMeshSurface::build(TriangleMesh::from_edge_lengths(mesh.vertices(), mesh.faces, lengths));
  };
  const auto a = surface_of(clean), b = surface_of(doubled);
  EXPECT_EQ(b.details().merged_vertices, 20);
  const LogMapSolver p(a.graph()), q(b.graph());
  const RowLogMap map = a.to_rows(p.solve(a.source(Row(9)).source)),
                  other = b.to_rows(q.solve(b.source(Row(9)).source));
  for (Index i = 0; i < clean.vertices(); ++i) ASSERT_NEAR(other.distance[i], map.distance[i], 1e-10);
}

TEST(CoincidentVertices, AreWhereTheSourceIs) {
  for (const double apart : {0.0, 1e-14, 1e-13, 1e-12}) {
    Mesh mesh = flat_square(11);
    const Triangle t = mesh.faces[103];
    const Vec3 at = mesh.positions[t[0]];
    mesh.positions[t[1]] = {at[0] + apart, at[1], at[2]};
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
    const LogMapSolver solver(surface.graph());
    for (const Index source : {t[0], t[1]}) {
      const RowLogMap map = surface.to_rows(solver.solve(surface.source(Row(source)).source));
      EXPECT_EQ(map.distance[source], 0) << apart;
      EXPECT_NEAR(map.distance[t[0] + t[1] - source], apart, 2e-12);
    }
  }
}

TEST(CoincidentVertices, AllOfAFaceAreOne) {
  // A face that shrank to a point, and its neighbours to lines.
  Mesh mesh = flat_square(11);
  const Triangle t = mesh.faces[103];
  const Vec2 at = mesh.plane[t[0]];
  for (Index v : t) mesh.plane[v] = at, mesh.positions[v] = {at[0], at[1], 0};
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().merged_vertices, 2);
  EXPECT_EQ(solved.surface.details().dropped_faces, 4);
  const SurfacePoint point = FacePoint{103, {0.2, 0.3, 0.5}};
  const RowLogMap map = solved.map(solved.surface.source(point).source);
  for (Index v : t) EXPECT_NEAR(map.distance[v], 0, 1e-12);
  for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_EQ(map.status[i], Status::ok);
}

TEST(CoincidentVertices, LeaveOutAComponentWithoutArea) {
  Mesh mesh = icosphere(4);
  const Index n = mesh.vertices();
  for (const Vec3& p : {Vec3{3, 0, 0}, Vec3{3, 0, 0}, Vec3{4, 0, 0}}) mesh.positions.push_back(p);
  mesh.faces.push_back({n, n + 1, n + 2});
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().topology.components, 1);
  EXPECT_EQ(solved.surface.details().dropped_faces, 1);
  const RowLogMap map = solved.map(solved.surface.source(Row(0)).source);
  for (Index i = 0; i < mesh.vertices(); ++i) ASSERT_EQ(map.status[i], i < n ? Status::ok : Status::removed);
  EXPECT_THROW(solved.surface.source(FacePoint{static_cast<Index>(mesh.faces.size()) - 1, {0.2, 0.3, 0.5}}),
               InvalidArgument);
}

TEST(CoincidentVertices, JoinedByNoEdgeLeaveThePlaneExact) {
  // Two vertices at the middle of one edge, each in a face of no height on one of its sides.
  Mesh mesh{{}, {}, {{0, 0}, {1, 0}, {0.5, 0}, {0.5, 0}, {0, 1}, {1, 1}, {0, -1}, {1, -1}, {0.5, 0.9}, {0.4, -0.8}}};
  for (const Vec2& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0});
  mesh.faces = {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 5}, {4, 2, 8},
                {2, 5, 8}, {3, 0, 6}, {1, 3, 7}, {3, 6, 9}, {7, 3, 9}};
  for (bool flips : {true, false}) {
    const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
    EXPECT_EQ(solved.surface.details().mollification, 0);
    for (Index source : {2, 3, 4})
      EXPECT_LT(
          PlaneErrors(mesh, solved.map(solved.surface.source(Row(source)).source), mesh.plane[source]).coordinates,
          1e-11)
          << source;
  }
}

TEST(CoincidentVertices, DropWhatHangsOnByALine) {
  // An ear at the boundary whose base has no length.
  Mesh mesh = flat_square(7);
  const Index n = mesh.vertices();
  const Triangle first = mesh.faces[0];  // at corner 0; side 0-1 is on the boundary
  mesh.plane[1] = mesh.plane[0];
  mesh.plane.push_back({0, -1});
  mesh.positions.clear();
  for (const Vec2& p : mesh.plane) mesh.positions.push_back({p[0], p[1], 0});
  mesh.faces.push_back({1, 0, n});
  ASSERT_EQ(first[0], 0);
  const SolvedMesh solved(mesh);
  const RowLogMap map = solved.map(solved.surface.source(Row(20)).source);
  EXPECT_EQ(map.status[n], Status::removed);
  EXPECT_EQ(map.status[0], Status::ok);
  EXPECT_EQ(map.distance[0], map.distance[1]);
  try {
    solved.surface.source(Row(n));
    ADD_FAILURE() << "a source at a row without a vertex";
  } catch (const InvalidArgument& e) {
    EXPECT_EQ(e.fault(), "row_without_area");
  }
  EXPECT_EQ(solved.surface.to_corners(solved.solver.solve(solved.surface.source(Row(20)).source)).size(),
            3 * mesh.faces.size());
}

TEST(CoincidentVertices, SplitAMeshWhereItIsAPointWide) {
  // Two squares joined by two faces about one edge without length.
  Mesh mesh{{{0, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {-2, 2, 0}, {2, 0, 0}, {2, 2, 0}}, {}, {}};
  mesh.positions[0] = mesh.positions[1] = {0, 1, 0};
  mesh.faces = {{2, 0, 1}, {2, 1, 3}, {0, 4, 1}, {4, 5, 1}};
  const SolvedMesh solved(mesh);
  EXPECT_EQ(solved.surface.details().topology.components, 2);
  EXPECT_EQ(solved.surface.rows().vertices(Row(0)).size(), 2);
  EXPECT_EQ(solved.surface.rows().vertices(Row(1)).size(), 2);
  const RowLogMap map = solved.map(solved.surface.source(Row(2)).source);
  EXPECT_EQ(map.status[0], Status::ok);
  EXPECT_EQ(map.status[1], Status::ok);
  EXPECT_EQ(map.status[4], Status::disconnected);
}

}  // namespace
}  // namespace ahm::test
