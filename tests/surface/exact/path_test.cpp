// Shortest paths and straight lines on polyhedral surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::GeodesicPath;
using exact::MeshPoint;
using exact::PolyhedralSurface;
using exact::TracedPath;
using exact::TraceEnd;
using std::numbers::pi;

/// Triangles a hundred times as long as high.
Mesh flat_strip() {
  return triangles(quads(61, 2, Columns::open, [](Index i, Index j) { return Vec3{0.001 * j, 0.1 * i, 0}; }));
}

TEST(GeodesicPath, IsAsLongAsTheExactDistance) {
  for (const auto& [name, mesh] : shapes()) {
    SCOPED_TRACE(name);
    const Polyhedron solid(mesh);
    const ExactMap map = solid.map(11);
    for (Index v = 0; v < map.size(); ++v) {
      const GeodesicPath path = exact::path_to_vertex(solid.surface, map, Vertex(v));
      EXPECT_EQ(path.length, map.distance(Vertex(v)));
      solid.expect_length(path);
      EXPECT_LT(distance(solid.position(path.points.front()), solid.position(11)), 1e-15);
      EXPECT_LT(distance(solid.position(path.points.back()), solid.position(v)), 1e-15);
    }
  }
}

TEST(GeodesicPath, JoinsPointsNearSidesAndVertices) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Mesh& mesh : {icosphere(7), flat_square(9, 0), moebius_mesh(40, 6), flat_strip()}) {
    const Polyhedron solid(mesh);
    const auto near_side = [&] {
      MeshPoint p = random_point(solid.surface, random);
      for (int s = 0; s < 2; ++s)
        if (s == 0 || uniform(random) < 0.3) p.barycentric[s] *= std::pow(10, (s == 0 ? -17 : -4) * uniform(random));
      normalize(p);
      return p;
    };
    for (int k = 0; k < 500; ++k) {
      const GeodesicPath path = solid.path(near_side(), near_side());
      solid.expect_length(path, 1e-10);
      if (path.points.size() >= 2)  // throws where consecutive points lie in no common face
        EXPECT_NEAR(exact::shortened_path(solid.surface, path.points).length, path.length, 1e-10);
    }
  }
}

TEST(GeodesicPath, StartsNearASideOfANeedle) {
  const Polyhedron solid(flat_strip());
  for (double weight : {0.0, 2e-14, 6e-14, 2e-13, 6e-13, 1e-12})
    for (Index face : {60, 61})
      for (int s = 0; s < 3; ++s) {
        MeshPoint from{face, {}};
        from.barycentric[s] = weight;
        from.barycentric[(s + 1) % 3] = 0.3;
        from.barycentric[(s + 2) % 3] = 0.7 - weight;
        const ExactMap map = exact::exact_map(solid.surface, from);
        for (Index v = 0; v < map.size(); ++v)
          EXPECT_NEAR(map.distance(Vertex(v)), distance(solid.position(from), solid.position(v)), 1e-12);
      }
}

// Also on a saddle without positions, and on a sphere with heights from 0.75 to 1.25 that has as many saddles as tips.
TEST(GeodesicPath, IsTheSameCurveInReverse) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> height(0.75, 1.25);
  std::vector<Polyhedron> solids{Polyhedron(PolarCone(8.0, 12, 4).mesh())};
  for (const auto& [name, mesh] : shapes()) solids.emplace_back(mesh);
  Mesh rough = icosphere(14);
  for (Vec3& p : rough.positions) p = height(random) * p;
  solids.emplace_back(rough);
  for (const Polyhedron& solid : solids)
    for (int k = 0; k < 40; ++k) {
      SCOPED_TRACE(testing::Message() << solid.mesh.vertex_count() << " vertices, trial " << k);
      const MeshPoint p = random_point(solid.surface, random), q = random_point(solid.surface, random);
      const GeodesicPath there = solid.path(p, q), back = solid.path(q, p);
      EXPECT_GT(there.length, 0);
      EXPECT_NEAR(there.length, back.length, 1e-12);
      EXPECT_NEAR(std::remainder(there.start_direction - back.end_direction, 2 * pi), 0, 1e-9);
      EXPECT_NEAR(std::remainder(there.end_direction - back.start_direction, 2 * pi), 0, 1e-9);
      if (!solid.mesh.has_positions()) continue;
      solid.expect_length(there);
      if (there.points.size() != back.points.size()) continue;  // they pass a vertex on different sides, up to rounding
      for (std::size_t j = 0; j < there.points.size(); ++j)
        EXPECT_LT(distance(solid.position(there.points[j]), solid.position(back.points[back.points.size() - 1 - j])),
                  1e-9);
    }
}

TEST(GeodesicPath, IsTheSumOfItsLegs) {
  const Polyhedron solid(icosphere(7));
  std::mt19937_64 random(12);
  const std::vector<MeshPoint> stops = random_points(solid.surface, 4, random);
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += solid.path(stops[k], stops[k + 1]).length;
  const GeodesicPath open = exact::geodesic_path(solid.surface, stops);
  EXPECT_NEAR(open.length, sum, 1e-13);
  EXPECT_NEAR(solid.length(open.points), sum, 1e-12);
  const GeodesicPath loop = exact::geodesic_path(solid.surface, stops, true);
  EXPECT_NEAR(loop.length, sum + solid.path(stops[3], stops[0]).length, 1e-13);
  EXPECT_LT(distance(solid.position(loop.points.front()), solid.position(loop.points.back())), 1e-15);
  EXPECT_EQ(loop.start_direction, open.start_direction);
  EXPECT_THROW(exact::geodesic_path(solid.surface, std::span(stops).first(1)), InvalidArgument);
}

// A bent strip that unrolls to a rectangle: rays leave its straight boundary at any small angle, or run along it.
TEST(GeodesicPath, RunsAlongTheBoundaryUpToRounding) {
  constexpr Index rows = 121;
  const Mesh mesh = triangles(quads(rows, 2, Columns::open, [](Index i, Index j) {
    return Vec3{0.05 * j, 0.1 * i, 0.3 * std::sin(1.2 * i)};
  }));
  const Polyhedron solid(mesh);
  std::vector<double> along{0};
  for (Index k = 1; k < rows; ++k)
    along.push_back(along.back() + distance(mesh.positions[2 * k - 2], mesh.positions[2 * k]));
  const auto unrolled = [&](const MeshPoint& p) {
    Vec2 place{};
    for (int s = 0; s < 3; ++s) {
      const Index v = solid.surface.record(3 * p.face + s).tail;
      place = place + p.barycentric[s] * Vec2{0.05 * (v % 2), along[v / 2]};
    }
    return place;
  };
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 3000; ++k) {
    std::vector<MeshPoint> ends = random_points(solid.surface, 2, random);
    for (MeshPoint& p : ends) {  // near a side, on a side, or at a vertex
      p.barycentric[p.face % 2 == 0 ? 0 : 1] *= k % 3 == 0 ? 0.0 : std::pow(10, -16 * uniform(random));
      if (uniform(random) < 0.3) p.barycentric = {0, 0, 1};
      normalize(p);
    }
    const GeodesicPath path = solid.path(ends[0], ends[1]);
    const double expected = norm(unrolled(ends[1]) - unrolled(ends[0])) / solid.mesh.length_unit();
    EXPECT_NEAR(solid.length(path.points), expected, 1e-12);
    EXPECT_NEAR(path.length, expected, 1e-12);
  }
}

/// Traces the paths of a map that pass no vertex, and compares their ends with the vertices. Returns the number of paths.
int expect_traces_end_at_vertices(const PolyhedralSurface& surface, const MeshPoint& from, double tolerance,
                                  const std::function<double(const MeshPoint&, Index)>& distance_to) {
  const ExactMap map = exact::exact_map(surface, from);
  int paths = 0;
  for (Vertex v(0); v.index < map.size(); ++v.index) {
    const std::vector<MeshPoint> points = exact::path_to_vertex(surface, map, v).points;
    const auto is_vertex = [](const MeshPoint& p) { return std::ranges::max(p.barycentric) > 1 - 1e-9; };
    if (points.size() < 2 || std::any_of(points.begin() + 1, points.end() - 1, is_vertex)) continue;
    const TracedPath ray = exact::trace(surface, from, map.direction(v), map.distance(v));
    EXPECT_NEAR(ray.length, map.distance(v), 1e-12);
    EXPECT_LT(distance_to(ray.points.back(), v.index), tolerance) << v.index;
    ++paths;
  }
  return paths;
}

TEST(Trace, FollowsTheShortestPathToItsEnd) {
  for (const auto& [name, mesh] : shapes()) {
    SCOPED_TRACE(name);
    const Polyhedron solid(mesh);
    std::mt19937_64 random(9);
    for (const MeshPoint& from : {solid.vertex(11), random_point(solid.surface, random)})
      EXPECT_GT(expect_traces_end_at_vertices(
                    solid.surface, from, 1e-9,
                    [&](const MeshPoint& end, Index v) { return distance(solid.position(end), solid.position(v)); }),
                5);
  }
}

// Each line passes hundreds of triangles, some 1e12 times as long as high.
TEST(Trace, FollowsPathsThroughNestedNeedles) {
  int paths = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const auto flat = nested_needles(seed);
    if (!flat) continue;
    const PolyhedralSurface& surface = flat->surface;
    const auto position = [&](const MeshPoint& p) {
      Vec3 sum{};
      for (int s = 0; s < 3; ++s) sum = sum + p.barycentric[s] * flat->positions[surface.record(3 * p.face + s).tail];
      return sum;
    };
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> angle(0, 2 * pi);
    for (int k = 0; k < 100; ++k) {
      const TracedPath ray = exact::trace(surface, random_point(surface, random), angle(random), 3 / flat->length_unit);
      EXPECT_EQ(ray.end, TraceEnd::complete);
      double length = 0;
      for (std::size_t p = 1; p < ray.points.size(); ++p)
        length += distance(position(ray.points[p - 1]), position(ray.points[p]));
      EXPECT_NEAR(length, 3, 1e-12);
    }
    for (Index source = 0; source < surface.vertex_count(); source += 80) try {
        paths += expect_traces_end_at_vertices(
            surface, surface.vertex_point(Vertex(source)), 1e-10,
            [&](const MeshPoint& end, Index v) { return distance(position(end), flat->positions[v]); });
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "windows_lost") << e.what();
      }
  }
  EXPECT_GT(paths, 5000);
}

TEST(Trace, IsStraightInThePlane) {
  const Polyhedron solid(sliver_square(400));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(0, 2 * pi);
  for (int k = 0; k < 100; ++k) {
    const MeshPoint from = random_point(solid.surface, random);
    const TracedPath ray = exact::trace(solid.surface, from, angle(random), 10);
    EXPECT_EQ(ray.end, TraceEnd::boundary);
    EXPECT_NEAR(distance(solid.position(from), solid.position(ray.points.back())), ray.length, 1e-12);
  }
}

TEST(Trace, RunsAlongTheBoundaryUpToRounding) {
  const Polyhedron solid(flat_square(5, 0));
  const MeshPoint from = solid.vertex(2);  // on a side of the square
  const double angle = solid.surface.angle_sum(2);
  for (double direction : {-1e-12, 0.0, 1e-12, 2 * pi - 1e-12, angle, angle + 1e-12}) {
    const TracedPath ray = exact::trace(solid.surface, from, direction, 0.4);
    EXPECT_NEAR(distance(solid.position(from), solid.position(ray.points.back())), 0.4, 1e-11) << direction;
  }
  for (double outside : {angle + 0.1, -0.1})
    EXPECT_THROW(exact::trace(solid.surface, from, outside, 1), InvalidArgument);
}

// A line through the apex of a cone ends on the opposite side of the unrolled cone.
TEST(Trace, PassesAVertexWithEqualAnglesOnBothSides) {
  for (double angle : {4.0, 8.0}) {
    const PolarCone cone(angle, 24, 5);
    const Polyhedron solid(cone.mesh());
    const Index start = 1 + 3 * 24;  // radius 0.8, angle 0
    const TracedPath ray = exact::trace(solid.surface, solid.vertex(start), solid.map(start).direction(Vertex(0)),
                                        1.2 / solid.mesh.length_unit());
    ASSERT_EQ(ray.end, TraceEnd::complete);
    const MeshPoint& end = ray.points.back();
    const auto corner = std::ranges::max_element(end.barycentric);
    EXPECT_NEAR(*corner, 1, 1e-9);
    const Index reached =
        solid.surface.record(3 * end.face + static_cast<Index>(corner - end.barycentric.begin())).tail;
    EXPECT_NEAR(cone.polar[reached][0], 0.4, 1e-12);
    EXPECT_NEAR(cone.polar[reached][1], angle / 2, 1e-12);
  }
}

}  // namespace
}  // namespace ahm::test
