#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "ahm/error.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/util/vec.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::GeodesicPath;
using exact::MeshPoint;
using exact::TracedPath;
using exact::TraceEnd;

std::vector<Mesh> shapes() {
  return {icosphere(7), sliver_square(300), holed_square(14), folded_strip(11), moebius_mesh(40, 6), maze(3)};
}

/// Of triangles a hundred times as long as high.
Mesh flat_strip() {
  Mesh mesh;
  for (Index k = 0; k <= 60; ++k)
    for (double x : {0.0, 0.001}) mesh.positions.push_back({x, 0.1 * k, 0});
  for (Index a = 0; a < 120; a += 2) {
    mesh.faces.push_back({a, a + 1, a + 3});
    mesh.faces.push_back({a, a + 3, a + 2});
  }
  return mesh;
}

TEST(GeodesicPath, IsAsLongAsTheExactDistance) {
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(11)));
    for (Index v = 0; v < map.size(); ++v) {
      const GeodesicPath path = exact::path_to_vertex(solid.surface, map, Vertex(v));
      EXPECT_EQ(path.length, map.distance(Vertex(v)));
      EXPECT_NEAR(solid.length(path.points), map.distance(Vertex(v)), 1e-12);
      EXPECT_LT(distance(solid.position(path.points.front()), solid.mesh.position(Vertex(11))), 1e-15);
      EXPECT_LT(distance(solid.position(path.points.back()), solid.mesh.position(Vertex(v))), 1e-15);
    }
  }
}

TEST(GeodesicPath, GoesThroughFacesThatSharePoints) {
  const Polyhedron solid(icosphere(7));
  std::mt19937_64 random(7);
  auto corners = [&](const MeshPoint& p) {
    std::vector<Index> used;
    for (int s = 0; s < 3; ++s)
      if (p.barycentric[s] > 0) used.push_back(solid.surface.record(3 * p.face + s).tail);
    return used;
  };
  for (int k = 0; k < 50; ++k) {
    const GeodesicPath path =
        exact::geodesic_path(solid.surface, random_point(solid.surface, random), random_point(solid.surface, random));
    for (std::size_t j = 1; j < path.points.size(); ++j) {
      std::vector<Index> all = corners(path.points[j - 1]);
      for (Index v : corners(path.points[j])) all.push_back(v);
      std::ranges::sort(all);
      EXPECT_LE(std::unique(all.begin(), all.end()) - all.begin(), 3) << "two neighbouring points lie in one face";
    }
  }
}

TEST(GeodesicPath, GoesThroughFacesThatSharePointsHoweverNearToASide) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Mesh& mesh : {icosphere(7), flat_square(9, 0), moebius_mesh(40, 6), flat_strip()}) {
    const Polyhedron solid(mesh);
    const auto beside = [&] {  // a side, and perhaps a vertex
      MeshPoint p = random_point(solid.surface, random);
      for (int s = 0; s < 2; ++s)
        if (s == 0 || uniform(random) < 0.3) p.barycentric[s] *= std::pow(10, (s == 0 ? -17 : -4) * uniform(random));
      const double sum = p.barycentric[0] + p.barycentric[1] + p.barycentric[2];
      for (double& weight : p.barycentric) weight /= sum;
      return p;
    };
    for (int k = 0; k < 500; ++k) {
      const GeodesicPath path = exact::geodesic_path(solid.surface, beside(), beside());
      EXPECT_NEAR(solid.length(path.points), path.length, 1e-10);
      if (path.points.size() < 2) continue;
      const GeodesicPath taut = exact::shortened_path(solid.surface, path.points);
      EXPECT_NEAR(taut.length, path.length, 1e-10);
    }
  }
}

TEST(GeodesicPath, StartsHoweverNearToASideOfANeedle) {
  const Polyhedron solid(flat_strip());
  for (double beside : {0.0, 2e-14, 6e-14, 2e-13, 6e-13, 1e-12})
    for (Index face : {60, 61})
      for (int s = 0; s < 3; ++s) {
        MeshPoint from{face, {}};
        from.barycentric[s] = beside;
        from.barycentric[(s + 1) % 3] = 0.3;
        from.barycentric[(s + 2) % 3] = 0.7 - beside;
        const ExactMap map = exact::exact_map(solid.surface, from);
        const Vec3 at = solid.position(from);
        for (Index v = 0; v < map.size(); ++v)
          EXPECT_NEAR(map.distance(Vertex(v)), distance(at, solid.mesh.position(Vertex(v))), 1e-12);
      }
}

TEST(GeodesicPath, IsTheSameCurveTurnedRound) {
  std::mt19937_64 random(4);
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    for (int k = 0; k < 30; ++k) {
      const MeshPoint p = random_point(solid.surface, random), q = random_point(solid.surface, random);
      const GeodesicPath there = exact::geodesic_path(solid.surface, p, q),
                         back = exact::geodesic_path(solid.surface, q, p);
      EXPECT_NEAR(there.length, back.length, 1e-12);
      EXPECT_NEAR(solid.length(there.points), there.length, 1e-12);
      auto wrapped = [](double a) { return std::remainder(a, 2 * std::numbers::pi); };
      EXPECT_NEAR(wrapped(there.start_direction - back.end_direction), 0, 1e-9);
      EXPECT_NEAR(wrapped(there.end_direction - back.start_direction), 0, 1e-9);
      if (there.points.size() != back.points.size()) continue;  // a point on either side of a vertex, within rounding
      for (std::size_t j = 0; j < there.points.size(); ++j)
        EXPECT_LT(distance(solid.position(there.points[j]), solid.position(back.points[back.points.size() - 1 - j])),
                  1e-9);
    }
  }
}

TEST(GeodesicPath, IsTheSumOfItsLegsThroughStopsAndBack) {
  const Polyhedron solid(icosphere(7));
  std::mt19937_64 random(12);
  std::vector<MeshPoint> stops;
  for (int k = 0; k < 4; ++k) stops.push_back(random_point(solid.surface, random));
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += exact::geodesic_path(solid.surface, stops[k], stops[k + 1]).length;
  const GeodesicPath open = exact::geodesic_path(solid.surface, stops);
  EXPECT_NEAR(open.length, sum, 1e-13);
  EXPECT_NEAR(solid.length(open.points), sum, 1e-12);
  const GeodesicPath loop = exact::geodesic_path(solid.surface, stops, true);
  EXPECT_NEAR(loop.length, sum + exact::geodesic_path(solid.surface, stops[3], stops[0]).length, 1e-13);
  EXPECT_LT(distance(solid.position(loop.points.front()), solid.position(loop.points.back())), 1e-15);
  EXPECT_EQ(loop.start_direction, open.start_direction);
  EXPECT_THROW(exact::geodesic_path(solid.surface, std::span(stops).first(1)), InvalidArgument);
}

bool passes_vertex(const GeodesicPath& path) {
  return std::any_of(path.points.begin() + 1, path.points.end() - 1,
                     [](const MeshPoint& p) { return std::ranges::max(p.barycentric) > 1 - 1e-9; });
}

TEST(GeodesicPath, RunsAlongTheBoundaryWithinRounding) {
  // A bent strip that unrolls to a rectangle: rays that leave its straight boundary at any small angle, or lie on it.
  constexpr Index cuts = 120;
  Mesh mesh;
  for (Index k = 0; k <= cuts; ++k)
    for (double x : {0.0, 0.05}) mesh.positions.push_back({x, 0.1 * k, 0.3 * std::sin(1.2 * k)});
  for (Index k = 0; k < cuts; ++k) {
    const Index a = 2 * k;
    mesh.faces.push_back({a, a + 1, a + 3});
    mesh.faces.push_back({a, a + 3, a + 2});
  }
  const Polyhedron solid(mesh);
  std::vector<double> along{0};
  for (Index k = 0; k < cuts; ++k)
    along.push_back(along.back() + distance(mesh.positions[2 * k], mesh.positions[2 * k + 2]));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto unrolled = [&](const MeshPoint& p) {
    Vec2 place{};
    for (int s = 0; s < 3; ++s) {
      const Index v = solid.surface.record(3 * p.face + s).tail;
      place[0] += p.barycentric[s] * 0.05 * (v % 2);
      place[1] += p.barycentric[s] * along[v / 2];
    }
    return place;
  };
  for (int k = 0; k < 3000; ++k) {
    MeshPoint end[2];
    for (MeshPoint& p : end) {  // near a side, on it, or a vertex
      p = random_point(solid.surface, random);
      const double small = k % 3 == 0 ? 0.0 : std::pow(10, -16 * uniform(random));
      p.barycentric[p.face % 2 == 0 ? 0 : 1] *= small;
      if (uniform(random) < 0.3) p.barycentric = {0, 0, 1};
      const double sum = p.barycentric[0] + p.barycentric[1] + p.barycentric[2];
      for (double& weight : p.barycentric) weight /= sum;
    }
    const GeodesicPath path = exact::geodesic_path(solid.surface, end[0], end[1]);
    const double expected = norm(unrolled(end[1]) - unrolled(end[0])) / solid.mesh.length_unit();
    EXPECT_NEAR(solid.length(path.points), expected, 1e-12);
    EXPECT_NEAR(path.length, expected, 1e-12);
  }
}

TEST(Trace, FollowsTheShortestPathToItsEnd) {
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    std::mt19937_64 random(9);
    for (const MeshPoint& from : {solid.surface.vertex_point(Vertex(11)), random_point(solid.surface, random)}) {
      const ExactMap map = exact::exact_map(solid.surface, from);
      Index straight = 0;
      for (Index v = 0; v < map.size(); ++v) {
        const GeodesicPath path = exact::path_to_vertex(solid.surface, map, Vertex(v));
        if (path.points.size() < 2 || passes_vertex(path)) continue;
        ++straight;
        const TracedPath ray = exact::trace(solid.surface, from, map.direction(Vertex(v)), map.distance(Vertex(v)));
        EXPECT_NEAR(ray.length, map.distance(Vertex(v)), 1e-12);
        EXPECT_LT(distance(solid.position(ray.points.back()), solid.mesh.position(Vertex(v))), 1e-9);
      }
      EXPECT_GT(straight, 5);
    }
  }
}

/// Needles of 1e-6 within needles of 1e-6: a line passes hundreds of them, some longer than they are high by 1e12.
TEST(Trace, FollowsPathsThroughNeedlesWithinNeedles) {
  int paths = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::optional<FlatTriangles> flat;
    try {
      flat = flat_triangles(nested_needles(seed));
    } catch (const InvalidGeometry&) {
      continue;  // a face without area
    }
    const exact::PolyhedralSurface& surface = flat->surface;
    const auto position = [&](const MeshPoint& p) {
      Vec3 sum{};
      for (int s = 0; s < 3; ++s) sum = sum + p.barycentric[s] * flat->positions[surface.record(3 * p.face + s).tail];
      return sum;
    };
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    for (int k = 0; k < 100; ++k) {
      const TracedPath ray = exact::trace(surface, random_point(surface, random), angle(random), 3 / flat->length_unit);
      EXPECT_EQ(ray.end, TraceEnd::complete);
      double length = 0;
      for (std::size_t p = 1; p < ray.points.size(); ++p)
        length += distance(position(ray.points[p - 1]), position(ray.points[p]));
      EXPECT_NEAR(length, 3, 1e-12);
    }
    for (Index source = 0; source < surface.vertex_count(); source += 80) try {
        const MeshPoint from = surface.vertex_point(Vertex(source));
        const ExactMap map = exact::exact_map(surface, from);
        for (Index v = 0; v < map.size(); ++v) {
          const GeodesicPath path = exact::path_to_vertex(surface, map, Vertex(v));
          if (path.points.size() < 2 || passes_vertex(path)) continue;
          ++paths;
          const TracedPath ray = exact::trace(surface, from, map.direction(Vertex(v)), map.distance(Vertex(v)));
          EXPECT_LT(distance(position(ray.points.back()), flat->positions[v]), 1e-10)
              << seed << ' ' << source << ' ' << v;
        }
      } catch (const InvalidGeometry& e) {
        EXPECT_EQ(e.fault(), "windows_lost") << e.what();
      }
  }
  EXPECT_GT(paths, 5000);
}

TEST(Trace, IsStraightInThePlaneWhateverTheTriangles) {
  const Polyhedron solid(sliver_square(400));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  for (int k = 0; k < 100; ++k) {
    const MeshPoint from = random_point(solid.surface, random);
    const TracedPath ray = exact::trace(solid.surface, from, angle(random), 10);
    EXPECT_EQ(ray.end, TraceEnd::boundary);
    EXPECT_NEAR(distance(solid.position(from), solid.position(ray.points.back())), ray.length, 1e-12);
  }
}

TEST(Trace, RunsAlongTheBoundaryWithinRounding) {
  const Polyhedron solid(flat_square(5, 0));
  const MeshPoint from = solid.surface.vertex_point(Vertex(2));  // on a side
  const double angle = solid.surface.angle_sum(2);
  for (double direction : {-1e-12, 0.0, 1e-12, 2 * std::numbers::pi - 1e-12, angle, angle + 1e-12}) {
    const TracedPath ray = exact::trace(solid.surface, from, direction, 0.4);
    EXPECT_NEAR(distance(solid.position(from), solid.position(ray.points.back())), 0.4, 1e-11) << direction;
  }
  EXPECT_THROW(exact::trace(solid.surface, from, angle + 0.1, 1), InvalidArgument);
  EXPECT_THROW(exact::trace(solid.surface, from, -0.1, 1), InvalidArgument);
}

TEST(Trace, PassesAVertexWithEqualAnglesOnBothSides) {
  // Towards the apex of a cone: it leaves on the opposite side of the unrolled cone, where the paths of both sides meet.
  for (double angle : {4.0, 8.0}) {
    const PolarCone cone(angle, 24, 5);
    const auto mesh =
        trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(cone.polar.size()), cone.faces, cone.lengths);
    const auto surface = surface_of(mesh);
    const Index start = 1 + 3 * 24;  // radius 0.8, angle 0
    const ExactMap map = exact::exact_map(surface, surface.vertex_point(Vertex(start)));
    const double unit = mesh.length_unit();
    const TracedPath ray =
        exact::trace(surface, surface.vertex_point(Vertex(start)), map.direction(Vertex(0)), 1.2 / unit);
    ASSERT_EQ(ray.end, TraceEnd::complete);
    const MeshPoint& end = ray.points.back();
    int corner = static_cast<int>(std::ranges::max_element(end.barycentric) - end.barycentric.begin());
    EXPECT_NEAR(end.barycentric[corner], 1, 1e-9);
    const Index reached = surface.record(3 * end.face + corner).tail;
    EXPECT_NEAR(cone.polar[reached][0], 0.4, 1e-12);
    EXPECT_NEAR(cone.polar[reached][1], angle / 2, 1e-12);
  }
}

TEST(Trace, ComesBackAfterAFullTurnOfTheEquator) {
  // Edges of an octahedron's equator: four vertices of equal angles.
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  const Polyhedron solid(mesh);
  const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(0)));
  const TracedPath ray = exact::trace(solid.surface, solid.surface.vertex_point(Vertex(0)), map.direction(Vertex(1)),
                                      4 * std::sqrt(2.0) / solid.mesh.length_unit());
  EXPECT_EQ(ray.end, TraceEnd::complete);
  EXPECT_LT(distance(solid.position(ray.points.back()), solid.mesh.position(Vertex(0))), 1e-12);
  EXPECT_NEAR(solid.length(ray.points), ray.length, 1e-12);
}

}  // namespace
}  // namespace ahm::test
