// What must not change the map, and what must change it in a known way.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/util/vec.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

/// A patch of a bumpy height field, with non-Delaunay edges.
Mesh bumpy(Index side = 20) {
  Mesh mesh = holed_square(side);
  mesh.positions.clear();
  for (const auto& p : mesh.plane)
    mesh.positions.push_back({p[0], p[1], 0.2 * std::sin(5 * p[0]) * std::cos(4 * p[1])});
  return mesh;
}

constexpr Vec3 east{1, 0, 0};

RowLogMap solve(const Mesh& mesh, Index source, Variant variant = Variant::adaptive) {
  const SolvedMesh solved(mesh);
  return solved.map(solved.surface.source(Row(source), east).source, variant);
}

TEST(MeshSymmetry, RelabellingVerticesAndFacesRelabelsTheMap) {
  const Mesh mesh = bumpy();
  std::mt19937_64 random(4);
  std::vector<Index> order(mesh.positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  std::shuffle(order.begin(), order.end(), random);
  Mesh other = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) other.positions[order[i]] = mesh.positions[i];
  std::shuffle(other.faces.begin(), other.faces.end(), random);
  for (Triangle& t : other.faces) {
    for (Index& v : t) v = order[v];
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
  }
  for (Variant variant : all_variants) {
    const RowLogMap a = solve(mesh, 100, variant), b = solve(other, order[100], variant);
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_NEAR(a.u[i], b.u[order[i]], 1e-11);
      ASSERT_NEAR(a.v[i], b.v[order[i]], 1e-11);
    }
  }
}

TEST(MeshSymmetry, ReversedOrientationIsTheMirrorImage) {
  const Mesh mesh = bumpy();
  Mesh other = mesh;
  for (Triangle& t : other.faces) std::swap(t[0], t[1]);
  for (Variant variant : all_variants) {
    const RowLogMap a = solve(mesh, 100, variant), b = solve(other, 100, variant);
    for (std::size_t i = 0; i < a.u.size(); ++i) {
      ASSERT_NEAR(a.u[i], b.u[i], 1e-11);
      ASSERT_NEAR(a.v[i], -b.v[i], 1e-11);
    }
  }
}

TEST(MeshSymmetry, MixedOrientationIsRepairedByTheMajority) {
  const Mesh mesh = bumpy();
  Mesh other = mesh;
  for (std::size_t f = 0; f < other.faces.size(); f += 3) std::swap(other.faces[f][1], other.faces[f][2]);
  const SolvedMesh solved(other);
  EXPECT_EQ(solved.surface.details().topology.reoriented, static_cast<Index>((other.faces.size() + 2) / 3));
  EXPECT_FALSE(solved.surface.warnings().empty());
  const RowLogMap a = solve(mesh, 100), b = solved.map(solved.surface.source(Row(100), east).source);
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    ASSERT_NEAR(a.u[i], b.u[i], 1e-11);
    ASSERT_NEAR(a.v[i], b.v[i], 1e-11);
  }
}

TEST(MeshSymmetry, PowersOfTwoScaleBitForBit) {
  const Mesh mesh = bumpy();
  const RowLogMap a = solve(mesh, 100);
  for (int exponent : {-1000, -20, 7, 1000}) {
    Mesh other = mesh;
    for (Vec3& p : other.positions)
      for (double& x : p) x = std::scalbn(x, exponent);
    const RowLogMap b = solve(other, 100);
    for (std::size_t i = 0; i < a.u.size(); ++i) ASSERT_EQ(std::scalbn(a.u[i], exponent), b.u[i]) << exponent;
  }
}

TEST(MeshSymmetry, AnyScaleScales) {
  const Mesh mesh = bumpy();
  const RowLogMap a = solve(mesh, 100);
  for (double scale : {1e-300, 1e-12, 1e12, 1e300}) {
    Mesh other = mesh;
    for (Vec3& p : other.positions)
      for (double& x : p) x *= scale;
    const RowLogMap b = solve(other, 100);
    for (std::size_t i = 0; i < a.u.size(); ++i) ASSERT_NEAR(a.u[i], b.u[i] / scale, 1e-11) << scale;
  }
}

TEST(MeshSymmetry, FarFromTheOriginIsAsGoodAsTheInputDigits) {
  const Mesh mesh = bumpy();
  const RowLogMap a = solve(mesh, 100);
  Mesh other = mesh;
  for (Vec3& p : other.positions) p = {p[0] + 1e8, p[1] - 1e8, p[2] + 1e8};
  const RowLogMap b = solve(other, 100);
  for (std::size_t i = 0; i < a.u.size(); ++i) ASSERT_NEAR(a.distance[i], b.distance[i], 1e-5);
}

/// Expects that the first stars of two graphs are the same bits, lengths but for the unit.
void expect_same_stars(const CsrGraph& a, const CsrGraph& b, Index count) {
  for (Index v = 0; v < count; ++v) {
    const Star one = a.star(v), other = b.star(v);
    ASSERT_EQ(one.degree(), other.degree()) << v;
    for (std::size_t e = 0; e < one.degree(); ++e) {
      ASSERT_EQ(one.neighbors[e], other.neighbors[e]) << v;
      ASSERT_EQ(one.weights[e], other.weights[e]) << v;
      for (int c = 0; c < 2; ++c) ASSERT_EQ(one.log(e)[c] * a.length_unit(), other.log(e)[c] * b.length_unit()) << v;
    }
  }
}

// Its trapezoids are cut along either diagonal, by rounding alone.
Mesh regular_torus(Index around, Index across) {
  Mesh mesh;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      mesh.positions.push_back(
          {(2 + 0.7 * std::cos(v)) * std::cos(u), (2 + 0.7 * std::cos(v)) * std::sin(u), 0.7 * std::sin(v)});
      const auto at = [&](Index x, Index y) { return x % around * across + y % across; };
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(MeshSymmetry, AComponentIsTheSameBitsBesideLargerOrNearerOnes) {
  Mesh part = regular_torus(30, 15);
  for (Vec3& p : part.positions) p = {p[0] * 1e-3 + 9, p[1] * 1e-3 + 9, p[2] * 1e-3 + 9};
  const auto alone = trimesh::TriangleMeshSurface::build(part.positions, part.faces);
  for (const auto& [scale, shift] : {std::pair{30.0, 500.0}, {1e9, 0.0}, {1e-6, 9.1}}) {
    Mesh other = icosphere(5);
    for (Vec3& p : other.positions) p = {p[0] * scale + shift, p[1] * scale + shift, p[2] * scale + shift};
    const Mesh both = joined(part, other);
    const auto beside = trimesh::TriangleMeshSurface::build(both.positions, both.faces);
    expect_same_stars(alone.graph(), beside.graph(), part.vertices());
  }
}

TEST(MeshSymmetry, AComponentIsTheSameWhereItTouchesAnotherOneAndVerticesCoincide) {
  Mesh part = regular_torus(30, 15);
  part.positions[7] = part.positions[22];  // neighbours
  const auto alone = trimesh::TriangleMeshSurface::build(part.positions, part.faces);
  Mesh other = icosphere(2);
  const Vec3 away = part.positions[100] - other.positions[3];
  for (Vec3& p : other.positions) p = p + away;
  // Either one first, and so the one whose copy the vertex is that they share.
  for (const bool is_first : {true, false}) {
    const Index shift = is_first ? 0 : other.vertices(), beyond = is_first ? part.vertices() : 0;
    Mesh both = is_first ? joined(part, other) : joined(other, part);
    for (Triangle& face : both.faces)
      for (Index& v : face)
        if (v == beyond + 3) v = shift + 100;
    const auto surface =
        trimesh::TriangleMeshSurface::build(both.positions, both.faces, {.non_manifold = NonManifold::split});
    const auto row = [&](Index v) { return Row(shift + v); };
    const auto map_of = [](const trimesh::TriangleMeshSurface& surface, Row source) {
      return surface.to_rows(LogMapSolver(surface.graph()).solve(surface.source(source).source));
    };
    const RowLogMap expected = map_of(alone, Row(40)), found = map_of(surface, row(40));
    for (Index v = 0; v < part.vertices(); ++v) {
      if (found.status[row(v).index] == Status::disconnected) continue;  // the row of the other one's copy
      ASSERT_NEAR(found.u[row(v).index], expected.u[v], 1e-9) << v;
      ASSERT_NEAR(found.v[row(v).index], expected.v[v], 1e-9) << v;
      ASSERT_NEAR(found.distance[row(v).index], expected.distance[v], 1e-9) << v;
    }
    const ExactGeodesics exact(surface);
    const auto end = exact.path(std::array<SurfacePoint, 2>{row(115), row(101)});
    const auto end_alone = ExactGeodesics(alone).path(std::array<SurfacePoint, 2>{Row(115), Row(101)});
    EXPECT_NEAR(end.length, end_alone.length, 1e-12);
  }
}

// A sliver has sides of 1e-14 of its length; the part beside it is so large that they would be nothing.
TEST(MeshSymmetry, AComponentOfLengthsIsTheSameBitsBesideLargerOnes) {
  std::vector<Triangle> faces{{0, 1, 2}, {0, 2, 3}};
  std::vector<std::array<double, 3>> lengths{{1e-14, 1, 1}, {1, 1, 1}};
  const auto alone = trimesh::TriangleMesh::from_edge_lengths(4, faces, lengths);
  faces.push_back({4, 5, 6});
  lengths.push_back({1e9, 1e9, 1e9});
  const auto beside = trimesh::TriangleMesh::from_edge_lengths(7, faces, lengths);
  EXPECT_EQ(alone.vertex_count(), 4);
  EXPECT_EQ(beside.vertex_count(), 7);
  const auto one = trimesh::TriangleMeshSurface::build(alone), other = trimesh::TriangleMeshSurface::build(beside);
  expect_same_stars(one.graph(), other.graph(), 4);
}

TEST(MeshSymmetry, RepeatsBitForBitOnAnyNumberOfThreads) {
  const Mesh mesh = bumpy(60);
  const auto one = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 1});
  const auto many = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = 7});
  EXPECT_EQ(one.graph().data().logs, many.graph().data().logs);
  EXPECT_EQ(one.graph().data().weights, many.graph().data().weights);
  EXPECT_EQ(one.graph().data().transports, many.graph().data().transports);
  EXPECT_EQ(one.graph().data().masses, many.graph().data().masses);
}

TEST(MeshSymmetry, TheUDirectionTurnsTheMap) {
  const SolvedMesh solved(bumpy());
  const RowLogMap a = solved.map(solved.surface.source(Row(100)).source);
  const Frame frame = *solved.surface.graph().frame(solved.surface.vertex(Row(100)).index);
  const RowLogMap b = solved.map(solved.surface.source(Row(100), frame.y).source);
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    ASSERT_NEAR(a.u[i], -b.v[i], 1e-11);
    ASSERT_NEAR(a.v[i], b.u[i], 1e-11);
  }
}

}  // namespace
}  // namespace ahm::test
