// Changes of the mesh that do not change the map, rotate it or mirror it.
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "meshes.hpp"

namespace ahm::test {
namespace {

/// A patch of a bumpy height field, with edges that are not Delaunay.
Mesh bumpy(Index side = 20) {
  Mesh mesh = holed_square(side);
  for (Index i = 0; i < mesh.vertices(); ++i) {
    const auto [x, y] = mesh.plane[i];
    mesh.positions[i] = {x, y, 0.2 * std::sin(5 * x) * std::cos(4 * y)};
  }
  return mesh;
}

RowLogMap solve(const Mesh& mesh, Index source, Variant variant = Variant::adaptive) {
  return SolvedMesh(mesh).map(Row(source), Vec3{1, 0, 0}, variant);
}

TEST(MeshSymmetry, RenumberedVerticesAndFacesRenumberTheMap) {
  const Mesh mesh = bumpy();
  std::mt19937_64 random(4);
  std::vector<Index> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0);
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
    expect_same_rows(a, b, 1e-11, [&](Index i) { return order[i]; });
  }
}

TEST(MeshSymmetry, ReversedOrientationIsTheMirrorImage) {
  const Mesh mesh = bumpy();
  Mesh other = mesh;
  for (Triangle& t : other.faces) std::swap(t[0], t[1]);
  for (Variant variant : all_variants) {
    RowLogMap mirrored = solve(other, 100, variant);
    for (double& v : mirrored.v) v = -v;
    EXPECT_LT(largest_difference(solve(mesh, 100, variant), mirrored), 1e-11);
  }
}

TEST(MeshSymmetry, MixedOrientationIsRepairedByTheMajority) {
  const Mesh mesh = bumpy();
  Mesh other = mesh;
  for (std::size_t f = 0; f < other.faces.size(); f += 3) std::swap(other.faces[f][1], other.faces[f][2]);
  const auto surface = build(other);
  EXPECT_EQ(surface.details().topology.reoriented, static_cast<Index>((other.faces.size() + 2) / 3));
  EXPECT_FALSE(surface.warnings().empty());
  EXPECT_LT(largest_difference(solve(mesh, 100), map_of(surface, Row(100), Vec3{1, 0, 0})), 1e-11);
}

TEST(MeshSymmetry, TheMapScales) {
  const Mesh mesh = bumpy();
  const RowLogMap map = solve(mesh, 100);
  for (double factor : {0x1p-1000, 0x1p-20, 0x1p7, 0x1p1000, 1e-300, 1e-12, 1e12, 1e300}) {
    int exponent;
    const double tolerance = std::frexp(factor, &exponent) == 0.5 ? 0 : 1e-11;  // powers of two: the same bits
    const RowLogMap larger = solve(moved(mesh, factor, {0, 0, 0}), 100);
    expect_near(larger.u, scaled(factor, map).u, factor * tolerance);
  }
}

TEST(MeshSymmetry, FarFromTheOriginIsAsGoodAsTheInputDigits) {
  const Mesh mesh = bumpy();
  const RowLogMap near = solve(mesh, 100), far = solve(moved(mesh, 1, {1e8, -1e8, 1e8}), 100);
  expect_near(near.distance, far.distance, 1e-5);
}

TEST(MeshSymmetry, DoesNotDependOnTheNumberOfThreads) {
  const Mesh mesh = bumpy(60);
  expect_same_bits(build(mesh, {.threads = 1}), build(mesh, {.threads = 7}));
}

/// Expects that the first one-rings of two graphs are the same bits, with lengths in world units.
void expect_same_stars(const Surface& first, const Surface& second, Index count) {
  const TangentGraph &a = first.graph(), &b = second.graph();
  for (Index v = 0; v < count; ++v) {
    const Star one = a.star(v), other = b.star(v);
    ASSERT_TRUE(std::ranges::equal(one.neighbors, other.neighbors)) << v;
    ASSERT_TRUE(std::ranges::equal(one.weights, other.weights)) << v;
    ASSERT_TRUE(std::ranges::equal(one.logs, other.logs, [&](double x, double y) {
      return x * a.length_unit() == y * b.length_unit();
    })) << v;
  }
}

/// A torus of 30 rings with 15 vertices each. Rounding decides along which diagonal its trapezoids are cut.
Mesh regular_torus() {
  return tube(30, 15, true, [](Index i, Index k) {
    const double u = 2 * std::numbers::pi * i / 30, v = 2 * std::numbers::pi * k / 15, r = 2 + 0.7 * std::cos(v);
    return Vec3{r * std::cos(u), r * std::sin(u), 0.7 * std::sin(v)};
  });
}

TEST(MeshSymmetry, AComponentIsTheSameBitsNextToOthers) {
  const Mesh part = moved(regular_torus(), 1e-3, {9, 9, 9});
  const auto alone = build(part);
  for (const auto& [scale, shift] : {std::pair{30.0, 500.0}, {1e9, 0.0}, {1e-6, 9.1}})
    expect_same_stars(alone, build(joined(part, moved(icosphere(5), scale, {shift, shift, shift}))), part.vertices());
}

// A sliver has sides of 1e-14 of its length; relative to the part next to it, they round to zero.
TEST(MeshSymmetry, AComponentOfLengthsIsTheSameBitsNextToLargerOnes) {
  std::vector<Triangle> faces{{0, 1, 2}, {0, 2, 3}};
  std::vector<std::array<double, 3>> lengths{{1e-14, 1, 1}, {1, 1, 1}};
  const auto alone = TriangleMesh::from_edge_lengths(4, faces, lengths);
  faces.push_back({4, 5, 6});
  lengths.push_back({1e9, 1e9, 1e9});
  const auto together = TriangleMesh::from_edge_lengths(7, faces, lengths);
  EXPECT_EQ(alone.vertex_count(), 4);
  EXPECT_EQ(together.vertex_count(), 7);
  expect_same_stars(TriangleMeshSurface::build(alone), TriangleMeshSurface::build(together), 4);
}

TEST(MeshSymmetry, AComponentIsTheSameWhereItTouchesAnotherOneAndVerticesCoincide) {
  Mesh part = regular_torus();
  part.positions[7] = part.positions[22];  // neighbors
  const auto alone = build(part);
  const Mesh other = moved(icosphere(2), 1, part.positions[100] - icosphere(2).positions[3]);
  // The component that comes first keeps the shared vertex; the other one gets its copy.
  for (const bool is_first : {true, false}) {
    const Index shift = is_first ? 0 : other.vertices(), beyond = is_first ? part.vertices() : 0;
    Mesh both = is_first ? joined(part, other) : joined(other, part);
    for (Triangle& face : both.faces) std::ranges::replace(face, beyond + 3, shift + 100);
    const auto surface = build(both, {.non_manifold = NonManifold::split});
    const RowLogMap expected = map_of(alone, Row(40)), found = map_of(surface, Row(shift + 40));
    for (Index v = 0; v < part.vertices(); ++v) {
      if (found.status[shift + v] == Status::disconnected) continue;  // the row of the other component's copy
      ASSERT_NEAR(found.u[shift + v], expected.u[v], 1e-9) << v;
      ASSERT_NEAR(found.v[shift + v], expected.v[v], 1e-9) << v;
      ASSERT_NEAR(found.distance[shift + v], expected.distance[v], 1e-9) << v;
    }
    const auto length = [](const Surface& surface, Row from, Row to) {
      return ExactGeodesics(surface).path(std::array<SurfacePoint, 2>{from, to}).length;
    };
    EXPECT_NEAR(length(surface, Row(shift + 115), Row(shift + 101)), length(alone, Row(115), Row(101)), 1e-12);
  }
}

}  // namespace
}  // namespace ahm::test
