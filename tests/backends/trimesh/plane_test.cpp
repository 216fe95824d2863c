// On the plane the map is the identity, whatever the triangles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "ahm/conformance/vectors.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

constexpr double tolerance = 1e-11;

struct FlatCase {
  std::string name;
  Mesh mesh;
};

std::vector<FlatCase> flat_cases() {
  return {{"slivers", sliver_square(600)},
          {"slivers 2", sliver_square(1500, 7)},
          {"holes", holed_square(40)},
          {"needles", holed_square(25, 3, 1e-3)},
          {"maze", maze(8)},
          {"folded", folded_strip(25)}};
}

/// The unit vector from one point of the plane to another.
std::array<double, 2> direction(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  const double x = b[0] - a[0], y = b[1] - a[1], r = std::hypot(x, y);
  return {x / r, y / r};
}

/// The map from a vertex against the plane, whose u axis is read off at the vertex farthest from the source.
double vertex_error(const Mesh& mesh, const RowLogMap& map, Index source) {
  std::size_t far = 0;
  auto distance = [&](std::size_t i) {
    return std::hypot(mesh.plane[i][0] - mesh.plane[source][0], mesh.plane[i][1] - mesh.plane[source][1]);
  };
  for (std::size_t i = 0; i < mesh.plane.size(); ++i)
    if (distance(i) > distance(far)) far = i;
  const auto there = direction(mesh.plane[source], mesh.plane[far]);
  const double r = std::hypot(map.u[far], map.v[far]), c = map.u[far] / r, s = map.v[far] / r;
  return plane_error(mesh, map, mesh.plane[source], {there[0] * c + there[1] * s, there[1] * c - there[0] * s});
}

// What is given at points goes to what is nearest to them. Along slivers on the boundary, which no flip removes, heat must not
// run as if they had no length.
TEST(MeshPlane, HeatDoesNotRunAlongSliversOnTheBoundary) {
  const Index n = 41;
  const Mesh mesh = dented_square(n);
  const SolvedMesh solved(mesh);
  EXPECT_LT(vertex_error(mesh, solved.map(Source::at_vertex(Vertex(3))), 3), tolerance * mesh.diameter());
  const std::array given{Vertex(0), Vertex(n - 1)};
  const VertexField field = extend_scalar(solved.solver, given, std::array{0.0, 1.0});
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const double x = mesh.plane[i][0] - 0.5 * (n - 1);
    const double nearer =
        std::abs(std::hypot(x + 0.5 * (n - 1), mesh.plane[i][1]) - std::hypot(x - 0.5 * (n - 1), mesh.plane[i][1]));
    if (nearer > 10) ASSERT_NEAR(field.values[i], x < 0 ? 0 : 1, 0.01) << "vertex " << i;
  }
}

TEST(MeshPlane, IsTheIdentityFromAnyVertex) {
  for (const auto& [name, mesh] : flat_cases())
    for (bool flips : {true, false}) {
      const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
      for (Index source : {0, 1, 3, mesh.vertices() / 2, mesh.vertices() - 1})
        for (Variant variant : all_variants) {
          const RowLogMap map = solved.map(solved.surface.source(Row(source)).source, variant);
          EXPECT_LT(vertex_error(mesh, map, source), tolerance * mesh.diameter())
              << name << (flips ? " flipped" : "") << ", vertex " << source << ", " << to_string(variant);
        }
    }
}

TEST(MeshPlane, PutsTheFrameWhereItSays) {
  for (const auto& [name, mesh] : flat_cases()) {
    if (name == "folded") continue;  // its faces are not in one plane
    const SolvedMesh solved(mesh);
    for (Index source : {0, mesh.vertices() / 2}) {
      const RowLogMap map = solved.map(solved.surface.source(Row(source)).source);
      const Frame frame = *solved.surface.graph().frame(solved.surface.vertex(Row(source)).index);
      for (Index i = 0; i < mesh.vertices(); ++i) {
        const Vec3& p = mesh.positions[i];
        const Vec3 offset{p[0] - frame.origin[0], p[1] - frame.origin[1], p[2] - frame.origin[2]};
        ASSERT_NEAR(map.u[i], dot(frame.x, offset), 2e-10) << name;
        ASSERT_NEAR(map.v[i], dot(frame.y, offset), 2e-10) << name;
      }
    }
  }
}

TEST(MeshPlane, IsTheIdentityFromPointsInFacesAndOnEdges) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const auto& [name, mesh] : flat_cases())
    for (bool flips : {true, false}) {
      const SolvedMesh solved(mesh, {.intrinsic_delaunay = flips});
      for (int trial = 0; trial < 6; ++trial) {
        const auto f = static_cast<Index>(random() % mesh.faces.size());
        FacePoint point{f, {uniform(random), uniform(random), 0}};
        if (point.barycentric[0] + point.barycentric[1] > 1)
          for (int s : {0, 1}) point.barycentric[s] = 1 - point.barycentric[s];
        point.barycentric[2] = 1 - point.barycentric[0] - point.barycentric[1];
        const auto& [a, b, c] = mesh.faces[f];
        const Variant variant = trial % 2 ? Variant::adaptive : Variant::localized;
        EXPECT_LT(plane_error(mesh, solved.map(solved.surface.source(point).source, variant), plane_point(mesh, point),
                              direction(mesh.plane[a], mesh.plane[b])),
                  tolerance * mesh.diameter())
            << name << (flips ? " flipped" : "") << ", face " << f;
        const double t = uniform(random);
        EXPECT_LT(plane_error(mesh, solved.map(solved.surface.source(EdgePoint{Row(c), Row(a), t}).source, variant),
                              mesh.plane_point(f, {t, 0, 1 - t}), direction(mesh.plane[c], mesh.plane[a])),
                  tolerance * mesh.diameter())
            << name << (flips ? " flipped" : "") << ", edge of face " << f;
      }
    }
}

TEST(MeshPlane, HoldsForEveryDiffusionTime) {
  const Mesh mesh = holed_square(25);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  for (double t_coef : {0.1, 1.0, 100.0}) {
    const LogMapSolver solver(surface.graph(), {.t_coef = t_coef});
    EXPECT_LT(vertex_error(mesh, surface.to_rows(solver.solve(surface.source(Row(7)).source)), 7), tolerance) << t_coef;
  }
}

TEST(MeshPlane, NeedsNoPositions) {
  const Mesh mesh = holed_square(30);
  std::vector<std::array<double, 3>> lengths;
  for (const auto& t : mesh.faces) {
    lengths.emplace_back();
    for (int s = 0; s < 3; ++s) {
      const auto &a = mesh.plane[t[s]], &b = mesh.plane[t[(s + 1) % 3]];
      lengths.back()[s] = std::hypot(a[0] - b[0], a[1] - b[1]);
    }
  }
  const auto surface = trimesh::TriangleMeshSurface::build(
      trimesh::TriangleMesh::from_edge_lengths(mesh.vertices(), mesh.faces, lengths));
  EXPECT_FALSE(surface.graph().frame(0).has_value());
  const LogMapSolver solver(surface.graph());
  EXPECT_LT(vertex_error(mesh, surface.to_rows(solver.solve(surface.source(Row(7)).source)), 7), tolerance);
  const FacePoint point{11, {0.2, 0.3, 0.5}};
  const auto map = surface.to_rows(solver.solve(surface.source(point).source));
  EXPECT_LT(plane_error(mesh, map, plane_point(mesh, point),
                        direction(mesh.plane[mesh.faces[11][0]], mesh.plane[mesh.faces[11][1]])),
            tolerance);
}

}  // namespace
}  // namespace ahm::test
