// Locally shortest paths and loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::GeodesicPath;
using exact::MeshPoint;
using exact::PolyhedralSurface;
using std::numbers::pi;

Index vertex_at(const PolyhedralSurface& surface, const MeshPoint& p) {
  for (int s = 0; s < 3; ++s)
    if (p.barycentric[s] > 1 - 1e-12) return surface.record(3 * p.face + s).tail;
  return -1;
}

/// The unscaled angle around a vertex of the direction to another point of one of its faces.
double angle_to(const PolyhedralSurface& surface, Index vertex, const MeshPoint& p) {
  double turned = 0;
  const exact::Corner first = surface.first_corner(vertex);
  exact::Corner c = first;
  do {
    // The weights of the point in this face, if it lies in the face.
    const exact::HalfRecord& r = surface.record(c.half);
    std::array<double, 3> weight{};
    double sum = 0;
    for (int s = 0; s < 3; ++s)
      for (int k = 0; k < 3; ++k)
        if (p.barycentric[s] > 0 && surface.record(3 * p.face + s).tail == std::array{r.tail, r.head, r.apex}[k])
          weight[k] += p.barycentric[s], sum += p.barycentric[s];
    if (sum > 1 - 1e-9) {
      const double within = std::atan2(weight[2] * r.apex_y, weight[1] * r.length + weight[2] * r.apex_x);
      return turned + (c.forward ? within : surface.angle(c.half) - within);
    }
    turned += surface.angle(c.half);
    c = surface.turn_left(c);
  } while (c.half >= 0 && c != first);
  ADD_FAILURE() << "consecutive points lie in no common face";
  return 0;
}

/// Expects that each vertex that the path passes has an angle of at least pi, or the boundary, on both sides.
void expect_locally_shortest(const PolyhedralSurface& surface, const std::vector<MeshPoint>& points, bool closed) {
  const std::size_t n = points.size();
  for (std::size_t k = closed ? 0 : 1; k + 1 < n; ++k) {
    const Index vertex = vertex_at(surface, points[k]);
    if (vertex < 0) continue;
    const double between =
        std::abs(angle_to(surface, vertex, points[k == 0 ? n - 2 : k - 1]) - angle_to(surface, vertex, points[k + 1]));
    EXPECT_GT(between, pi - 1e-7);
    if (!surface.on_boundary(vertex)) EXPECT_GT(surface.angle_sum(vertex) - between, pi - 1e-7);
  }
}

double edge_distance(const PolyhedralSurface& surface, Index from, Index to) {
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

TEST(LocallyShortestPath, JoinsVerticesSidesAndFaces) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  for (const auto& [name, mesh] : shapes()) {
    const Polyhedron solid(mesh);
    const PolyhedralSurface& surface = solid.surface;
    for (const int corners : {1, 2, 3})  // of a face: with positive weights
      for (int k = 0; k < 30; ++k) {
        SCOPED_TRACE(testing::Message() << name << ", points between " << corners << " vertices, trial " << k);
        std::vector<MeshPoint> ends = random_points(surface, 2, random);
        for (MeshPoint& p : ends) {
          const double t = corners == 1 ? 1 : share(random);
          const std::size_t s = random() % 3;
          if (corners < 3) p.barycentric = {0, 0, 0}, p.barycentric[s] = t, p.barycentric[(s + 1) % 3] = 1 - t;
        }
        const GeodesicPath path = exact::locally_shortest_path(surface, ends[0], ends[1]);
        EXPECT_GE(path.length, solid.path(ends[0], ends[1]).length - 1e-12);
        solid.expect_length(path);
        EXPECT_LT(distance(solid.position(path.points.front()), solid.position(ends[0])), 1e-15);
        EXPECT_LT(distance(solid.position(path.points.back()), solid.position(ends[1])), 1e-12);
        expect_locally_shortest(surface, path.points, false);
        if (corners == 1)
          EXPECT_LE(path.length,
                    edge_distance(surface, vertex_at(surface, ends[0]), vertex_at(surface, ends[1])) + 1e-12);
      }
  }
}

// Cones, whose angles are those of a disk except at the tip. In the plane there is only one locally shortest path, unlike
// next to holes.
TEST(LocallyShortestPath, IsTheShortestOnConesAndPlanes) {
  std::vector<Mesh> meshes{flat_square(20), sliver_square(200)};
  for (double height : {0.1, 0.5, 1.0, 3.0}) {
    Mesh& cone = meshes.emplace_back();
    cone.positions = {{0, 0, height}};
    for (Index k = 0; k < 13; ++k) {
      cone.positions.push_back({std::cos(2 * pi * k / 13), std::sin(2 * pi * k / 13), 0});
      cone.faces.push_back({0, k + 1, (k + 1) % 13 + 1});
    }
  }
  std::mt19937_64 random(7);
  for (const Mesh& mesh : meshes) {
    const Polyhedron solid(mesh);
    for (int k = 0; k < 100; ++k) {
      const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
      EXPECT_NEAR(exact::locally_shortest_path(solid.surface, a, b).length,
                  mesh.plane.empty() ? solid.path(a, b).length : distance(solid.position(a), solid.position(b)), 1e-12);
    }
  }
}

TEST(LocallyShortestPath, StartsInTheDirectionThatATraceFollows) {
  std::mt19937_64 random(6);
  const Polyhedron solid(icosphere(7));
  for (int k = 0; k < 40; ++k) {
    const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
    const GeodesicPath path = exact::locally_shortest_path(solid.surface, a, b);
    const auto there = exact::trace(solid.surface, a, path.start_direction, path.length),
               back = exact::trace(solid.surface, b, path.end_direction, path.length);
    EXPECT_LT(distance(solid.position(there.points.back()), solid.position(b)), 1e-9);
    EXPECT_LT(distance(solid.position(back.points.back()), solid.position(a)), 1e-9);
  }
}

TEST(LocallyShortestPath, DoesNotDependOnTheLowerBound) {
  std::mt19937_64 random(6);
  const Polyhedron solid(torus(300));
  for (int k = 0; k < 20; ++k) {
    const MeshPoint a = random_point(solid.surface, random), b = random_point(solid.surface, random);
    const auto straight = [&](Vertex v) { return distance(solid.mesh.position(v), solid.position(b)); };
    EXPECT_NEAR(exact::locally_shortest_path(solid.surface, a, b, straight).length,
                exact::locally_shortest_path(solid.surface, a, b).length, 1e-12);
  }
}

TEST(LocallyShortestPath, IsEmptyBetweenComponents) {
  const Mesh one = flat_square(5);
  const Polyhedron solid(joined(one, one, {5, 0, 0}));
  const GeodesicPath path = exact::locally_shortest_path(solid.surface, solid.vertex(0), solid.vertex(one.vertices()));
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.points.empty());
}

TEST(ShortenedPath, RefusesACurveThatJumps) {
  const Polyhedron solid(icosphere(4));
  const std::vector<MeshPoint> curve{solid.vertex(0), solid.vertex(11)};
  EXPECT_THROW(exact::shortened_path(solid.surface, curve), InvalidArgument);
  EXPECT_THROW(exact::shortened_path(solid.surface, std::span(curve).first(1)), InvalidArgument);
}

/// Shortens the shortest closed path through the stops.
GeodesicPath shortened_loop(const Polyhedron& solid, const std::vector<MeshPoint>& stops) {
  const std::vector<MeshPoint> curve = exact::geodesic_path(solid.surface, stops, true).points;
  const GeodesicPath loop = exact::shortened_loop(solid.surface, curve);
  EXPECT_LE(loop.length, solid.length(curve) + 1e-12);
  solid.expect_length(loop);
  if (loop.length > 0) {
    EXPECT_LT(distance(solid.position(loop.points.front()), solid.position(loop.points.back())), 1e-12);
    expect_locally_shortest(solid.surface, loop.points, true);
  } else {
    EXPECT_LE(loop.points.size(), 1U);
  }
  return loop;
}

// The shortest loops around the tube and around the hole of a torus, and around a Moebius band, are closed geodesics. In the
// plane every loop shrinks to a point.
TEST(ShortenedLoop, IsAClosedGeodesicOrAPoint) {
  struct Case {
    const char* name;
    Mesh mesh;
    unsigned seed;
    int stops, trials, least, most;  ///< least, most: bounds of the number of loops that do not shrink to a point
  };
  for (const auto& [name, mesh, seed, stops, trials, least, most] :
       {Case{"torus", torus(300), 2, 4, 20, 1, 20}, Case{"Moebius band", moebius_mesh(40, 6), 4, 3, 10, 1, 10},
        Case{"sphere", icosphere(6), 2, 3, 10, 0, 10}, Case{"square", flat_square(13), 2, 3, 10, 0, 0}}) {
    SCOPED_TRACE(name);
    const Polyhedron solid(mesh);
    std::mt19937_64 random(seed);
    int loops = 0;
    for (int k = 0; k < trials; ++k)
      loops += shortened_loop(solid, random_points(solid.surface, stops, random)).length > 0;
    EXPECT_GE(loops, least);
    EXPECT_LE(loops, most);
  }
}

// All loops around a prism are as long as its girth.
TEST(ShortenedLoop, RunsStraightAroundATube) {
  const int n = 9;
  const Polyhedron solid(triangles(quads(6, n, Columns::closed, [](Index i, Index j) {
    return Vec3{std::cos(2 * pi * j / n), std::sin(2 * pi * j / n), 0.7 * i + 0.05 * ((i * 7 + j * 3) % 4)};
  })));
  std::vector<MeshPoint> stops;
  for (int j = 0; j < n; j += 2) stops.push_back(solid.vertex(n * (1 + j % 4) + j));
  EXPECT_NEAR(shortened_loop(solid, stops).length * solid.mesh.length_unit(), 2 * n * std::sin(pi / n), 1e-12);
}

// The simple closed geodesics of a cube have lengths 4, 3 sqrt 2 and 2 sqrt 5. None passes a corner, whose angle is below 2 pi.
TEST(ShortenedLoop, FindsTheClosedGeodesicsOfACube) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) mesh.positions.push_back({1.0 * (k & 1), 1.0 * (k >> 1 & 1), 1.0 * (k >> 2 & 1)});
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Polyhedron solid(mesh);
  std::mt19937_64 random(11);
  int closed = 0;
  for (int k = 0; k < 60; ++k) {
    const double length =
        shortened_loop(solid, random_points(solid.surface, 5, random)).length * solid.mesh.length_unit();
    if (length == 0) continue;
    ++closed;
    double error = HUGE_VAL;
    for (double known : {4.0, 3 * std::sqrt(2.0), 2 * std::sqrt(5.0)})
      error = std::min(error, std::abs(length - known));
    EXPECT_LT(error, 1e-9) << length;
  }
  EXPECT_GT(closed, 5);
}

}  // namespace
}  // namespace ahm::test
