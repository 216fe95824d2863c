#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::ExactOptions;
using exact::MeshPoint;
using exact::PolyhedralSurface;

ExactOptions within(double tolerance) {
  ExactOptions options;
  options.tolerance = tolerance;
  return options;
}

/// Bumps over a square: vertices of more and less than 2 pi, and a boundary.
Mesh bumps(Index side) {
  Mesh mesh = flat_square(side);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec2& p = mesh.plane[v];
    mesh.positions[v] = {p[0], p[1], 0.1 * std::sin(9 * p[0]) * std::cos(11 * p[1])};
  }
  return mesh;
}

std::vector<Mesh> tolerance_shapes() {
  return {split_icosphere(2500), torus(900),       bumps(25), sliver_square(300), holed_square(14), cone_patch(9, 4.0),
          moebius_mesh(30, 5),   folded_strip(11), maze(4),   icosphere(1)};
}

/// A vertex, a point of an edge and one of a face.
std::vector<MeshPoint> places(const PolyhedralSurface& surface) {
  std::mt19937_64 random(5);
  const Index edge = surface.face_count() / 3;
  return {
      surface.vertex_point(Vertex(surface.vertex_count() / 3)), {edge, {0.3, 0.7, 0}}, random_point(surface, random)};
}

/// The largest relative difference of distances at vertices and targets.
double difference(const ExactMap& map, const ExactMap& exact) {
  double worst = 0;
  const auto compare = [&](Status status, Status expected, double a, double b) {
    EXPECT_EQ(status, expected);
    if (status == Status::ok && b > 0) worst = std::max(worst, std::abs(a / b - 1));
  };
  for (Index i = 0; i < map.size(); ++i) {
    const Vertex v(i);
    compare(map.status(v), exact.status(v), map.distance(v), exact.distance(v));
  }
  for (std::size_t k = 0; k < map.targets(); ++k)
    compare(map.target_status(k), exact.target_status(k), map.target_distance(k), exact.target_distance(k));
  return worst;
}

TEST(ExactTolerance, BoundsTheErrorsOfDistances) {
  for (const Mesh& mesh : tolerance_shapes()) {
    const Polyhedron solid(mesh);
    std::mt19937_64 random(3);
    std::vector<MeshPoint> targets;
    for (int k = 0; k < 100; ++k) targets.push_back(random_point(solid.surface, random));
    for (const MeshPoint& source : places(solid.surface)) {
      ExactOptions options;
      options.targets = targets;
      const ExactMap exact = exact::exact_map(solid.surface, source, options);
      for (double tolerance : {0.1, 1e-2, 1e-3, 1e-5, 1e-9}) {
        options.tolerance = tolerance;
        EXPECT_LE(difference(exact::exact_map(solid.surface, source, options), exact), tolerance + 1e-12)
            << mesh.vertices() << " vertices, " << tolerance;
      }
    }
  }
}

TEST(ExactTolerance, BoundsTheErrorsFromSeveralSources) {
  for (const Mesh& mesh : tolerance_shapes()) {
    const Polyhedron solid(mesh);
    const std::vector<MeshPoint> sources = places(solid.surface);
    const ExactMap exact = exact::exact_map(solid.surface, sources);
    const std::vector<ExactMap> each = exact::exact_maps(solid.surface, sources);
    const ExactMap map = exact::exact_map(solid.surface, sources, within(1e-3));
    EXPECT_LE(difference(map, exact), 1e-3);
    for (Index i = 0; i < map.size(); ++i) {
      const Vertex v(i);
      const ExactMap& own = each[static_cast<std::size_t>(map.source(v))];
      EXPECT_LE(own.distance(v), exact.distance(v) * (1 + 2e-3)) << "source of vertex " << i;
    }
  }
}

TEST(ExactTolerance, BoundsTheErrorsOfTargetsAlone) {
  const Polyhedron solid(bumps(31));
  std::mt19937_64 random(9);
  for (int k = 0; k < 20; ++k) {
    ExactOptions options;
    options.targets = {random_point(solid.surface, random), solid.surface.vertex_point(Vertex(11 * k))};
    options.only_targets = true;
    const MeshPoint source = random_point(solid.surface, random);
    const ExactMap exact = exact::exact_map(solid.surface, source, options);
    options.tolerance = 1e-3;
    const ExactMap map = exact::exact_map(solid.surface, source, options);
    for (std::size_t t = 0; t < 2; ++t) {
      ASSERT_EQ(map.target_status(t), Status::ok);
      EXPECT_NEAR(map.target_distance(t), exact.target_distance(t), 1e-3 * exact.target_distance(t));
    }
  }
}

/// A path that is longer by a part e than the shortest leaves up to about sqrt(2 e) beside it.
TEST(ExactTolerance, BoundsDirectionsOnThePlane) {
  const Mesh mesh = flat_square(31);
  const Polyhedron solid(mesh);
  const MeshPoint middle = solid.surface.vertex_point(Vertex(480));
  const ExactMap exact = exact::exact_map(solid.surface, middle);
  for (double tolerance : {1e-2, 1e-3, 1e-4}) {
    const ExactMap map = exact::exact_map(solid.surface, middle, within(tolerance));
    for (Index i = 0; i < map.size(); ++i) {
      const double turn = std::remainder(map.direction(Vertex(i)) - exact.direction(Vertex(i)), 2 * std::numbers::pi);
      EXPECT_LE(std::abs(turn), std::sqrt(2 * tolerance)) << i;
    }
  }
}

/// Windows of exact maps of spheres grow as n^1.5.
TEST(ExactTolerance, TakesWindowsInProportionToTheVertices) {
  const auto windows = [](Index n, double tolerance) {
    const Polyhedron solid(split_icosphere(n));
    return static_cast<double>(
        exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(n / 11)), within(tolerance))
            .statistics()
            .windows);
  };
  EXPECT_LT(windows(10000, 1e-3), 5 * windows(2500, 1e-3));
  EXPECT_LT(windows(10000, 1e-3), 0.1 * windows(10000, 0));
}

TEST(ExactTolerance, EndsAtTheRadius) {
  const Polyhedron solid(split_icosphere(2500));
  const MeshPoint source = solid.surface.vertex_point(Vertex(7));
  const ExactMap exact = exact::exact_map(solid.surface, source);
  ExactOptions options = within(1e-3);
  const ExactMap whole = exact::exact_map(solid.surface, source, options);
  options.radius = 1;
  const ExactMap part = exact::exact_map(solid.surface, source, options);
  EXPECT_LT(part.statistics().windows, 0.6 * whole.statistics().windows);
  for (Index i = 0; i < part.size(); ++i) {
    const Vertex v(i);
    if (exact.distance(v) < 0.999) {
      ASSERT_EQ(part.status(v), Status::ok);
      EXPECT_NEAR(part.distance(v), exact.distance(v), 1e-3 * exact.distance(v));
    } else if (exact.distance(v) > 1.001) {
      EXPECT_EQ(part.status(v), Status::beyond_radius);
    }
  }
}

TEST(ExactTolerance, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Polyhedron solid(bumps(15));
  std::vector<MeshPoint> sources;
  for (Index v = 0; v < 20; ++v) sources.push_back(solid.surface.vertex_point(Vertex(9 * v)));
  const auto one = exact::exact_maps(solid.surface, sources, within(1e-3), 1),
             four = exact::exact_maps(solid.surface, sources, within(1e-3), 4);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(std::ranges::equal(one[k].distances(), four[k].distances()));
    EXPECT_TRUE(std::ranges::equal(one[k].directions(), four[k].directions()));
  }
}

TEST(ExactTolerance, HasToBeSmallAndHasNoPaths) {
  const Polyhedron solid(icosphere(3));
  const MeshPoint source = solid.surface.vertex_point(Vertex(0));
  for (double bad : {-1e-3, 0.2, std::nan("")})
    EXPECT_THROW(exact::exact_map(solid.surface, source, within(bad)), InvalidArgument) << bad;
  const ExactMap map = exact::exact_map(solid.surface, source, within(1e-3));
  EXPECT_EQ(map.tolerance(), 1e-3);
  EXPECT_THROW(exact::path_to_vertex(solid.surface, map, Vertex(5)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
