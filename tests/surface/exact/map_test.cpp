// Exact maps with and without tolerance: sources, targets, statuses, axes, threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::ExactOptions;
using exact::MeshPoint;
using exact::PolyhedralSurface;

double angle_difference(double a, double b) { return std::remainder(a - b, 2 * std::numbers::pi); }

ExactOptions within(double tolerance) { return {.tolerance = tolerance}; }

void expect_same_distances(const ExactMap& a, const ExactMap& b, double tolerance) {
  for (Index v = 0; v < a.size(); ++v) EXPECT_NEAR(a.distance(Vertex(v)), b.distance(Vertex(v)), tolerance) << v;
}

TEST(ExactMap, HasTheAxesOfTheTriangleBackend) {
  for (const Mesh& mesh : {icosphere(5), cone_patch(9, 4.0), moebius_mesh(30, 5)}) {
    const Polyhedron solid(mesh);
    const auto backend = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = false});
    for (Index v = 0; v < solid.surface.vertex_count(); v += 7) {
      const ExactMap map = solid.map(v);
      const Star star = backend.graph().star(v);
      for (std::size_t k = 0; k < star.neighbors.size(); ++k) {
        const Vec2 uv = map.coordinates(Vertex(star.neighbors[k]));
        EXPECT_NEAR(uv[0], star.logs[2 * k], 1e-12);
        EXPECT_NEAR(uv[1], star.logs[2 * k + 1], 1e-12);
      }
    }
  }
}

TEST(ExactMap, OfSeveralSourcesIsThatOfTheNearest) {
  const Polyhedron solid(icosphere(8));
  std::mt19937_64 random(2);
  std::vector<MeshPoint> sources = random_points(solid.surface, 3, random);
  sources.insert(sources.end(), {solid.vertex(3), {10, {0.5, 0.5, 0}}});
  const ExactMap all = exact::exact_map(solid.surface, sources);
  const std::vector<ExactMap> each = exact::exact_maps(solid.surface, sources);
  for (Vertex v(0); v.index < all.size(); ++v.index) {
    double nearest = HUGE_VAL;
    for (const ExactMap& map : each) nearest = std::min(nearest, map.distance(v));
    const ExactMap& own = each[static_cast<std::size_t>(all.source(v))];
    EXPECT_NEAR(all.distance(v), nearest, 1e-13);
    EXPECT_NEAR(own.distance(v), nearest, 1e-13);
    EXPECT_NEAR(angle_difference(all.direction(v), own.direction(v)), 0, 1e-11);
  }
}

// In needles, rays of one source pass close to the other sources.
TEST(ExactMap, OfSeveralSourcesIsThatOfTheNearestInNeedles) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Mesh mesh = sliver_square(150, seed);
    const Polyhedron solid(mesh);
    std::mt19937_64 random(seed);
    const std::vector<MeshPoint> sources = random_points(solid.surface, 12, random);
    const ExactMap map = exact::exact_map(solid.surface, sources);
    for (Index v = 0; v < map.size(); ++v) {
      double nearest = HUGE_VAL;
      for (const MeshPoint& s : sources)
        nearest = std::min(nearest, norm(mesh.plane_point(s.face, s.barycentric) - mesh.plane[v]));
      EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), nearest, 1e-12) << seed << ' ' << v;
    }
  }
}

TEST(ExactMap, IsContinuousInItsSource) {
  const Polyhedron solid(icosphere(6));
  const MeshPoint corner = solid.vertex(20);
  MeshPoint in_face = corner, on_edge = corner;
  for (double& b : in_face.barycentric) b = b > 0 ? 1 - 2e-9 : 1e-9;
  for (int s = 0; s < 3; ++s)
    if (corner.barycentric[s] > 0) on_edge.barycentric[s] = 1 - 1e-9, on_edge.barycentric[(s + 1) % 3] = 1e-9;
  for (const MeshPoint& near : {in_face, on_edge})
    expect_same_distances(exact::exact_map(solid.surface, near), solid.map(20), 2e-9);
}

TEST(ExactMap, OfAPointOnAnEdgeDoesNotDependOnItsFace) {
  const Polyhedron solid(icosphere(6));
  for (exact::Half h = 0; h < 120; h += 3) {
    // The left side of h is side h + 2 of this face and side t of the other face.
    const exact::Half t = solid.surface.record(h).beyond_left;
    MeshPoint here{h / 3, {0.3, 0, 0.7}}, there{t / 3, {0, 0, 0}};
    there.barycentric[t % 3] = 0.3;
    there.barycentric[exact::next(t) % 3] = 0.7;
    expect_same_distances(exact::exact_map(solid.surface, here), exact::exact_map(solid.surface, there), 1e-13);
  }
}

TEST(ExactMap, DoesNotReachOtherComponents) {
  const Mesh one = icosphere(3);
  const Index n = one.vertices();
  const Polyhedron solid(joined(one, one, {5, 0, 0}));
  ExactOptions options;
  options.targets = {solid.vertex(n + 1), {0, {0.2, 0.3, 0.5}}};
  const ExactMap map = solid.map(n - 1, options);
  for (Index v = 0; v < map.size(); ++v) EXPECT_EQ(map.status(Vertex(v)), v < n ? Status::ok : Status::disconnected);
  EXPECT_EQ(map.target_status(0), Status::disconnected);
  EXPECT_EQ(map.target_status(1), Status::ok);
  const auto path = exact::path_to_vertex(solid.surface, map, Vertex(n));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.points.empty());
}

/// Bumps over a square: a boundary, and angle sums above and below 2 pi.
Mesh bumps(Index side) {
  Mesh mesh = flat_square(side);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto [x, y] = mesh.plane[v];
    mesh.positions[v] = {x, y, 0.1 * std::sin(9 * x) * std::cos(11 * y)};
  }
  return mesh;
}

TEST(ExactMap, DoesNotDependOnTheNumberOfThreads) {
  const Polyhedron solid(bumps(15));
  std::vector<MeshPoint> sources;
  for (Index v = 0; v < 20; ++v) sources.push_back(solid.vertex(9 * v));
  for (double tolerance : {0.0, 1e-3}) {
    const auto one = exact::exact_maps(solid.surface, sources, within(tolerance), 1),
               four = exact::exact_maps(solid.surface, sources, within(tolerance), 4);
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_TRUE(std::ranges::equal(one[k].distances(), four[k].distances()));
      EXPECT_TRUE(std::ranges::equal(one[k].directions(), four[k].directions()));
    }
  }
}

TEST(ExactMap, EndsAtTheRadius) {
  const Polyhedron solid(split_icosphere(2500));
  const ExactMap exact = solid.map(7);
  for (double tolerance : {0.0, 1e-3}) {
    SCOPED_TRACE(tolerance);
    const ExactMap whole = solid.map(7, within(tolerance)), part = solid.map(7, {.radius = 1, .tolerance = tolerance});
    EXPECT_LT(part.statistics().windows, (tolerance > 0 ? 0.6 : 0.5) * whole.statistics().windows);
    for (Vertex v(0); v.index < part.size(); ++v.index) {
      if (exact.distance(v) <= 1 - tolerance) {
        ASSERT_EQ(part.status(v), Status::ok);
        EXPECT_NEAR(part.distance(v), exact.distance(v), tolerance * exact.distance(v));
        if (tolerance == 0) EXPECT_EQ(part.direction(v), exact.direction(v));
      } else if (exact.distance(v) > 1 + tolerance) {
        EXPECT_EQ(part.status(v), Status::beyond_radius);
        EXPECT_TRUE(std::isnan(part.distance(v)));
      }
    }
  }
}

/// The largest relative difference of distances at vertices and targets.
double relative_error(const ExactMap& map, const ExactMap& exact) {
  double largest = 0;
  const auto compare = [&](Status status, Status expected, double a, double b) {
    EXPECT_EQ(status, expected);
    if (status == Status::ok && b > 0) largest = std::max(largest, std::abs(a / b - 1));
  };
  for (Vertex v(0); v.index < map.size(); ++v.index)
    compare(map.status(v), exact.status(v), map.distance(v), exact.distance(v));
  for (std::size_t k = 0; k < map.targets(); ++k)
    compare(map.target_status(k), exact.target_status(k), map.target_distance(k), exact.target_distance(k));
  return largest;
}

TEST(ExactTolerance, BoundsTheErrorsOfDistances) {
  std::vector<NamedMesh> meshes = shapes();
  meshes.insert(meshes.end(), {{"fine sphere", split_icosphere(2500)},
                               {"fine torus", torus(900)},
                               {"bumps", bumps(25)},
                               {"cone", cone_patch(9, 4.0)},
                               {"large maze", maze(4)},
                               {"icosahedron", icosphere(1)}});
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    const Polyhedron solid(mesh);
    const PolyhedralSurface& surface = solid.surface;
    std::mt19937_64 random(3);
    const std::vector<MeshPoint> sources{
        solid.vertex(mesh.vertices() / 3), {surface.face_count() / 3, {0.3, 0.7, 0}}, random_point(surface, random)};
    std::vector<MeshPoint> targets = random_points(surface, 100, random);
    targets[0] = solid.vertex(11);
    for (const MeshPoint& source : sources) {
      const ExactMap exact = exact::exact_map(surface, source, {.targets = targets});
      for (double tolerance : {0.1, 1e-2, 1e-3, 1e-5, 1e-9})
        EXPECT_LE(
            relative_error(exact::exact_map(surface, source, {.tolerance = tolerance, .targets = targets}), exact),
            tolerance + 1e-12);
      const ExactOptions few{.tolerance = 1e-3, .targets = {targets[0], targets[1]}, .only_targets = true};
      const ExactMap part = exact::exact_map(surface, source, few);
      for (std::size_t t = 0; t < 2; ++t) {
        ASSERT_EQ(part.target_status(t), Status::ok);
        EXPECT_NEAR(part.target_distance(t), exact.target_distance(t), 1e-3 * exact.target_distance(t));
      }
    }
    // From all sources at once: vertices between two sources may have either of them.
    const ExactMap exact = exact::exact_map(surface, sources), map = exact::exact_map(surface, sources, within(1e-3));
    const std::vector<ExactMap> each = exact::exact_maps(surface, sources);
    EXPECT_LE(relative_error(map, exact), 1e-3);
    for (Vertex v(0); v.index < map.size(); ++v.index)
      EXPECT_LE(each[static_cast<std::size_t>(map.source(v))].distance(v), exact.distance(v) * (1 + 2e-3)) << v.index;
  }
}

// A path longer than the shortest one by a factor 1 + e leaves the source at an angle of up to about sqrt(2 e) to it.
TEST(ExactTolerance, BoundsDirectionsOnThePlane) {
  const Polyhedron solid(flat_square(31));
  const ExactMap exact = solid.map(480);
  for (double tolerance : {1e-2, 1e-3, 1e-4}) {
    const ExactMap map = solid.map(480, within(tolerance));
    for (Vertex v(0); v.index < map.size(); ++v.index)
      EXPECT_LE(std::abs(angle_difference(map.direction(v), exact.direction(v))), std::sqrt(2 * tolerance));
  }
}

// The number of windows of exact maps of spheres grows as n^1.5.
TEST(ExactTolerance, MakesWindowsInProportionToTheVertices) {
  const auto windows = [](Index n, double tolerance) {
    return static_cast<double>(Polyhedron(split_icosphere(n)).map(n / 11, within(tolerance)).statistics().windows);
  };
  EXPECT_LT(windows(10000, 1e-3), 5 * windows(2500, 1e-3));
  EXPECT_LT(windows(10000, 1e-3), 0.1 * windows(10000, 0));
}

TEST(ExactTolerance, IsSmallAndHasNoPaths) {
  const Polyhedron solid(icosphere(3));
  for (double bad : {-1e-3, 0.2, std::nan("")}) EXPECT_THROW(solid.map(0, within(bad)), InvalidArgument) << bad;
  const ExactMap map = solid.map(0, within(1e-3));
  EXPECT_EQ(map.tolerance(), 1e-3);
  EXPECT_THROW(exact::path_to_vertex(solid.surface, map, Vertex(5)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
