// Locally shortest paths and loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::GeodesicPath;
using exact::MeshPoint;
using std::numbers::pi;

std::vector<Mesh> shapes() {
  return {icosphere(7),        torus(300), sliver_square(200), holed_square(14), folded_strip(11),
          moebius_mesh(40, 6), maze(3)};
}

Index vertex_at(const exact::PolyhedralSurface& surface, const MeshPoint& p) {
  for (int s = 0; s < 3; ++s)
    if (p.barycentric[s] > 1 - 1e-12) return surface.record(3 * p.face + s).tail;
  return -1;
}

/// The true angle about a vertex at which another point of one of its faces is seen.
double angle_to(const exact::PolyhedralSurface& surface, Index vertex, const MeshPoint& p) {
  double turned = 0;
  const exact::Corner first = surface.first_corner(vertex);
  exact::Corner c = first;
  do {
    // The weights of the point in this face, if it lies in it.
    const exact::HalfRecord& r = surface.record(c.half);
    std::array<double, 3> weight{};
    double sum = 0;
    for (int s = 0; s < 3; ++s) {
      if (!(p.barycentric[s] > 0)) continue;
      const Index v = surface.record(3 * p.face + s).tail;
      for (int k = 0; k < 3; ++k)
        if (v == std::array{r.tail, r.head, r.apex}[k]) weight[k] += p.barycentric[s], sum += p.barycentric[s];
    }
    if (sum > 1 - 1e-9) {
      const double x = weight[1] * r.length + weight[2] * r.apex_x, y = weight[2] * r.apex_y;
      const double within = std::atan2(y, x);
      return turned + (c.forward ? within : surface.angle(c.half) - within);
    }
    turned += surface.angle(c.half);
    c = surface.turn_left(c);
  } while (c.half >= 0 && c != first);
  ADD_FAILURE() << "neighbouring points lie in no common face";
  return 0;
}

/// Whether both sides of the vertices passed have an angle of pi at least, or the boundary.
void expect_locally_shortest(const exact::PolyhedralSurface& surface, const std::vector<MeshPoint>& points,
                             bool closed) {
  const std::size_t n = points.size();
  for (std::size_t k = closed ? 0 : 1; k + 1 < n; ++k) {
    const Index vertex = vertex_at(surface, points[k]);
    if (vertex < 0) continue;
    const MeshPoint& before = points[k == 0 ? n - 2 : k - 1];
    const double a = angle_to(surface, vertex, before), b = angle_to(surface, vertex, points[k + 1]);
    const double between = std::abs(a - b), rest = surface.angle_sum(vertex) - between;
    EXPECT_GT(between, pi - 1e-7);
    if (!surface.on_boundary(vertex)) EXPECT_GT(rest, pi - 1e-7);
  }
}

double edge_distance(const exact::PolyhedralSurface& surface, Index from, Index to) {
  std::vector<double> d(static_cast<std::size_t>(surface.vertex_count()), HUGE_VAL);
  d[from] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (exact::Half h = 0; h < 3 * surface.face_count(); ++h) {
      const exact::HalfRecord& r = surface.record(h);
      for (const auto& [a, b] : {std::pair(r.tail, r.head), std::pair(r.head, r.tail)})
        if (d[a] + r.length < d[b] - 1e-15) d[b] = d[a] + r.length, changed = true;
    }
  }
  return d[to];
}

TEST(LocallyShortestPath, LiesBetweenTheExactOneAndTheEdges) {
  std::mt19937_64 random(3);
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    const auto& surface = solid.surface;
    for (int k = 0; k < 30; ++k) {
      const auto from = static_cast<Index>(random() % static_cast<unsigned>(surface.vertex_count()));
      const auto to = static_cast<Index>(random() % static_cast<unsigned>(surface.vertex_count()));
      if (from == to) continue;
      const MeshPoint a = surface.vertex_point(Vertex(from)), b = surface.vertex_point(Vertex(to));
      const GeodesicPath path = exact::locally_shortest_path(surface, a, b);
      const double exact = exact::geodesic_path(surface, a, b).length;
      EXPECT_GE(path.length, exact - 1e-12);
      EXPECT_LE(path.length, edge_distance(surface, from, to) + 1e-12);
      EXPECT_NEAR(solid.length(path.points), path.length, 1e-12);
      EXPECT_EQ(vertex_at(surface, path.points.front()), from);
      EXPECT_EQ(vertex_at(surface, path.points.back()), to);
      expect_locally_shortest(surface, path.points, false);
    }
  }
}

/// A path between them that is locally shortest, no shorter than the shortest, and as long as it says.
void expect_joined(const Polyhedron& solid, const MeshPoint& a, const MeshPoint& b) {
  const GeodesicPath path = exact::locally_shortest_path(solid.surface, a, b);
  EXPECT_GE(path.length, exact::geodesic_path(solid.surface, a, b).length - 1e-12);
  EXPECT_NEAR(solid.length(path.points), path.length, 1e-12);
  EXPECT_LT(distance(solid.position(path.points.front()), solid.position(a)), 1e-15);
  EXPECT_LT(distance(solid.position(path.points.back()), solid.position(b)), 1e-12);
  expect_locally_shortest(solid.surface, path.points, false);
}

TEST(LocallyShortestPath, JoinsPointsInsideFaces) {
  std::mt19937_64 random(5);
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    for (int k = 0; k < 30; ++k) {
      const MeshPoint a = random_point(solid.surface, random);
      expect_joined(solid, a, random_point(solid.surface, random));
    }
  }
}

TEST(LocallyShortestPath, JoinsPointsOfSides) {
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  for (const Mesh& mesh : shapes()) {
    const Polyhedron solid(mesh);
    const auto on_side = [&] {
      MeshPoint p = random_point(solid.surface, random);
      const int side = static_cast<int>(random() % 3);
      const double t = share(random);
      p.barycentric = {0, 0, 0};
      p.barycentric[side] = t;
      p.barycentric[(side + 1) % 3] = 1 - t;
      return p;
    };
    for (int k = 0; k < 30; ++k) {
      const MeshPoint a = on_side();
      expect_joined(solid, a, on_side());
    }
  }
}

/// A round tip of flat faces: all angles but that at the tip are those of a disk.
Mesh cone_mesh(Index sides, double height) {
  Mesh mesh{{{0, 0, height}}, {}, {}};
  for (Index k = 0; k < sides; ++k) {
    const double angle = 2 * pi * k / sides;
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.faces.push_back({0, k + 1, (k + 1) % sides + 1});
  }
  return mesh;
}

TEST(LocallyShortestPath, PassesATipOnTheShorterSide) {
  std::mt19937_64 random(7);
  for (double height : {0.1, 0.5, 1.0, 3.0}) {
    const Polyhedron solid(cone_mesh(13, height));
    for (int k = 0; k < 100; ++k) {
      const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
      EXPECT_NEAR(exact::locally_shortest_path(solid.surface, a, b).length,
                  exact::geodesic_path(solid.surface, a, b).length, 1e-12);
    }
  }
}

TEST(LocallyShortestPath, IsTheShortestInThePlane) {
  // Where there is one locally shortest path only; beside holes there are several.
  std::mt19937_64 random(8);
  for (const Mesh& mesh : {flat_square(20), sliver_square(200)}) {
    const Polyhedron solid(mesh);
    for (int k = 0; k < 50; ++k) {
      const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
      EXPECT_NEAR(exact::locally_shortest_path(solid.surface, a, b).length,
                  distance(solid.position(a), solid.position(b)), 1e-12);
    }
  }
}

TEST(LocallyShortestPath, LeavesInTheDirectionThatATraceFollows) {
  std::mt19937_64 random(6);
  const Polyhedron solid(icosphere(7));
  for (int k = 0; k < 40; ++k) {
    const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
    const GeodesicPath path = exact::locally_shortest_path(solid.surface, a, b);
    const auto there = exact::trace(solid.surface, a, path.start_direction, path.length);
    const auto back = exact::trace(solid.surface, b, path.end_direction, path.length);
    EXPECT_LT(distance(solid.position(there.points.back()), solid.position(b)), 1e-9);
    EXPECT_LT(distance(solid.position(back.points.back()), solid.position(a)), 1e-9);
  }
}

TEST(LocallyShortestPath, SearchesTheSameWithABound) {
  std::mt19937_64 random(6);
  const Polyhedron solid(torus(300));
  for (int k = 0; k < 20; ++k) {
    const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
    const auto straight = [&](Vertex v) { return distance(solid.mesh.position(v), solid.position(b)); };
    EXPECT_NEAR(exact::locally_shortest_path(solid.surface, a, b, straight).length,
                exact::locally_shortest_path(solid.surface, a, b).length, 1e-12);
  }
}

TEST(LocallyShortestPath, EndsWhereTheSurfaceDoes) {
  Mesh two = flat_square(4);
  const Index n = two.vertices();
  const Mesh one = two;
  for (const Vec3& p : one.positions) two.positions.push_back({p[0] + 5, p[1], p[2]});
  for (const Triangle& t : one.faces) two.faces.push_back({t[0] + n, t[1] + n, t[2] + n});
  const Polyhedron solid(two);
  const GeodesicPath path = exact::locally_shortest_path(solid.surface, solid.surface.vertex_point(Vertex(0)),
                                                         solid.surface.vertex_point(Vertex(n)));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.points.empty());
}

TEST(ShortenedPath, RefusesACurveThatJumps) {
  const Polyhedron solid(icosphere(4));
  const std::vector<MeshPoint> curve{solid.surface.vertex_point(Vertex(0)), solid.surface.vertex_point(Vertex(11))};
  EXPECT_THROW(exact::shortened_path(solid.surface, curve), InvalidArgument);
  EXPECT_THROW(exact::shortened_path(solid.surface, std::span(curve).first(1)), InvalidArgument);
}

/// Shortest paths from stop to stop and back.
std::vector<MeshPoint> around(const exact::PolyhedralSurface& surface, const std::vector<MeshPoint>& stops) {
  return exact::geodesic_path(surface, stops, true).points;
}

TEST(ShortenedLoop, IsAClosedGeodesicOfATorus) {
  // Stops on a wavy way about the tube and about the hole: the shortest loops of their kinds are closed geodesics.
  const Mesh mesh = torus(300);
  const Polyhedron solid(mesh);
  std::mt19937_64 random(2);
  for (int k = 0; k < 20; ++k) {
    std::vector<MeshPoint> stops;
    for (int j = 0; j < 4; ++j) stops.push_back(random_point(solid.surface, random));
    const auto curve = around(solid.surface, stops);
    const GeodesicPath loop = exact::shortened_loop(solid.surface, curve);
    EXPECT_LE(loop.length, solid.length(curve) + 1e-12);
    EXPECT_NEAR(solid.length(loop.points), loop.length, 1e-12);
    if (loop.length == 0) continue;
    EXPECT_LT(distance(solid.position(loop.points.front()), solid.position(loop.points.back())), 1e-12);
    expect_locally_shortest(solid.surface, loop.points, true);
  }
}

TEST(ShortenedLoop, GoesRoundATubeStraight) {
  // A prism of n sides: all loops around it are as long as its girth.
  const int n = 9, rings = 6;
  Mesh mesh;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < n; ++j)
      mesh.positions.push_back(
          {std::cos(2 * pi * j / n), std::sin(2 * pi * j / n), 0.7 * i + 0.05 * ((i * 7 + j * 3) % 4)});
  for (int i = 0; i + 1 < rings; ++i)
    for (int j = 0; j < n; ++j) {
      const Index a = i * n + j, b = i * n + (j + 1) % n, c = a + n, d = b + n;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  const Polyhedron solid(mesh);
  std::vector<MeshPoint> stops;
  for (int j = 0; j < n; j += 2) stops.push_back(solid.surface.vertex_point(Vertex(n * (1 + j % 4) + j)));
  const GeodesicPath loop = exact::shortened_loop(solid.surface, around(solid.surface, stops));
  EXPECT_NEAR(loop.length * solid.mesh.length_unit(), 2 * n * std::sin(pi / n), 1e-12);
}

TEST(ShortenedLoop, FindsTheClosedGeodesicsOfACube) {
  // Simple ones are 4, 3 sqrt 2 and 2 sqrt 5 long; none runs through a corner, whose angles are less than 2 pi.
  Mesh mesh;
  for (int k = 0; k < 8; ++k) mesh.positions.push_back({1.0 * (k & 1), 1.0 * (k >> 1 & 1), 1.0 * (k >> 2 & 1)});
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Polyhedron solid(mesh);
  std::mt19937_64 random(11);
  int closed = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<MeshPoint> stops;
    for (int j = 0; j < 5; ++j) stops.push_back(random_point(solid.surface, random));
    const GeodesicPath loop = exact::shortened_loop(solid.surface, around(solid.surface, stops));
    EXPECT_NEAR(solid.length(loop.points), loop.length, 1e-12);
    if (loop.length == 0) continue;
    ++closed;
    const double length = loop.length * solid.mesh.length_unit();
    double off = HUGE_VAL;
    for (double known : {4.0, 3 * std::sqrt(2.0), 2 * std::sqrt(5.0)}) off = std::min(off, std::abs(length - known));
    EXPECT_LT(off, 1e-9) << length;
  }
  EXPECT_GT(closed, 5);
}

TEST(ShortenedLoop, ShrinksToAPointWhereItGoesAroundNothing) {
  for (const Mesh& mesh : {flat_square(12), icosphere(6)}) {
    const Polyhedron solid(mesh);
    std::mt19937_64 random(2);
    for (int k = 0; k < 10; ++k) {
      std::vector<MeshPoint> stops;
      for (int j = 0; j < 3; ++j) stops.push_back(random_point(solid.surface, random));
      const GeodesicPath loop = exact::shortened_loop(solid.surface, around(solid.surface, stops));
      EXPECT_LE(loop.points.size(), loop.length > 0 ? loop.points.size() : 1);
      if (mesh.faces.size() == flat_square(12).faces.size()) EXPECT_EQ(loop.length, 0);
      if (loop.length > 0) expect_locally_shortest(solid.surface, loop.points, true);
    }
  }
}

TEST(ShortenedLoop, FollowsTheMiddleOfAMoebiusBand) {
  const Polyhedron solid(moebius_mesh(40, 6));
  const auto& surface = solid.surface;
  std::mt19937_64 random(4);
  double shortest = HUGE_VAL;
  for (int k = 0; k < 10; ++k) {
    std::vector<MeshPoint> stops;
    for (int j = 0; j < 3; ++j) stops.push_back(random_point(surface, random));
    const GeodesicPath loop = exact::shortened_loop(surface, around(surface, stops));
    if (loop.length == 0) continue;
    expect_locally_shortest(surface, loop.points, true);
    EXPECT_NEAR(solid.length(loop.points), loop.length, 1e-12);
    shortest = std::min(shortest, loop.length);
  }
  EXPECT_LT(shortest, HUGE_VAL) << "some of the loops go once around";
}

}  // namespace
}  // namespace ahm::test
