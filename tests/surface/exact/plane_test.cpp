#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::PolyhedralSurface;

Vec2 minus(const Vec2& a, const Vec2& b) { return {a[0] - b[0], a[1] - b[1]}; }
double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Largest difference between a vertex's map and the plane seen from it, along its first edge.
double plane_error(const Mesh& mesh, const Polyhedron& solid, Index source) {
  const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(source)));
  const Index ahead = solid.surface.record(solid.surface.first_corner(source).half).head;
  const Vec2 u = minus(mesh.plane[ahead], mesh.plane[source]);
  const double length = std::hypot(u[0], u[1]), unit = solid.mesh.length_unit();
  double worst = 0;
  for (Index v = 0; v < map.size(); ++v) {
    const Vec2 d = minus(mesh.plane[v], mesh.plane[source]), uv = map.coordinates(Vertex(v));
    worst = std::max({worst, std::abs(uv[0] * unit - (d[0] * u[0] + d[1] * u[1]) / length),
                      std::abs(uv[1] * unit - cross(u, d) / length)});
    EXPECT_EQ(map.status(Vertex(v)), Status::ok);
  }
  return worst;
}

TEST(ExactMap, IsThePlaneOnAnyTriangulationOfASquare) {
  for (unsigned seed : {1u, 2u, 3u}) {
    const Mesh mesh = sliver_square(600, seed);
    const Polyhedron solid(mesh);
    for (Index source : {0, 5, 77, 300}) EXPECT_LT(plane_error(mesh, solid, source), 1e-12) << seed << ' ' << source;
  }
}

TEST(ExactMap, IsThePlaneOnAFoldedSheet) {
  const Mesh mesh = folded_strip(15);
  const Polyhedron solid(mesh);
  for (Index source : {0, 112, 200}) EXPECT_LT(plane_error(mesh, solid, source), 1e-12);
}

/// Shortest paths in a flat mesh with holes, through the vertices of its boundary, by seeing from vertex to vertex.
class VisibilityGraph {
 public:
  VisibilityGraph(const Mesh& mesh, const PolyhedralSurface& surface) : mesh_(mesh) {
    for (exact::Half h = 0; h < 3 * surface.face_count(); ++h) {
      const auto& r = surface.record(exact::next(h));
      // The side h itself is the left side of the next half-edge.
      if (r.beyond_left < 0) sides_.push_back({surface.record(h).tail, surface.record(h).head});
    }
  }

  std::vector<double> distances(Index source) const {
    const std::size_t n = mesh_.plane.size();
    std::vector<double> d(n, std::numeric_limits<double>::infinity());
    std::vector<bool> done(n, false), bends(n, false);
    for (const auto& side : sides_) bends[side[0]] = bends[side[1]] = true;
    d[source] = 0;
    for (;;) {
      std::size_t next = n;
      for (std::size_t v = 0; v < n; ++v)
        if (!done[v] && d[v] < (next < n ? d[next] : std::numeric_limits<double>::infinity())) next = v;
      if (next == n) return d;
      done[next] = true;
      if (!bends[next] && static_cast<Index>(next) != source) continue;
      for (std::size_t v = 0; v < n; ++v) {
        const Vec2 step = minus(mesh_.plane[v], mesh_.plane[next]);
        const double through = d[next] + std::hypot(step[0], step[1]);
        if (through < d[v] && sees(mesh_.plane[next], mesh_.plane[v])) d[v] = through;
      }
    }
  }

 private:
  bool sees(const Vec2& p, const Vec2& q) const {
    for (const auto& [i, j] : sides_) {
      const Vec2 &a = mesh_.plane[i], &b = mesh_.plane[j];
      const double pa = cross(minus(q, p), minus(a, p)), pb = cross(minus(q, p), minus(b, p));
      const double ap = cross(minus(b, a), minus(p, a)), aq = cross(minus(b, a), minus(q, a));
      constexpr double touch = 1e-14;
      if (std::min(pa, pb) < -touch && std::max(pa, pb) > touch && std::min(ap, aq) < -touch &&
          std::max(ap, aq) > touch)
        return false;
    }
    const Vec2 middle{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    return std::any_of(mesh_.faces.begin(), mesh_.faces.end(), [&](const Triangle& t) {
      bool inside = true;
      for (int s = 0; s < 3; ++s)
        inside = inside && cross(minus(mesh_.plane[t[(s + 1) % 3]], mesh_.plane[t[s]]),
                                 minus(middle, mesh_.plane[t[s]])) > -1e-14;
      return inside;
    });
  }

  const Mesh& mesh_;
  std::vector<std::array<Index, 2>> sides_;
};

TEST(ExactMap, BendsAroundHoles) {
  for (unsigned seed : {1u, 2u}) {
    const Mesh mesh = holed_square(14, seed);
    const Polyhedron solid(mesh);
    const VisibilityGraph graph(mesh, solid.surface);
    for (Index source : {0, 40, 90}) {
      const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(source)));
      const std::vector<double> expected = graph.distances(source);
      for (Index v = 0; v < map.size(); ++v)
        EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), expected[v], 1e-12)
            << seed << ' ' << source << ' ' << v;
    }
  }
}

TEST(ExactMap, FollowsTheCorridorsOfAMaze) {
  const Mesh mesh = maze(3);
  const Polyhedron solid(mesh);
  const VisibilityGraph graph(mesh, solid.surface);
  const ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(0)));
  const std::vector<double> expected = graph.distances(0);
  for (Index v = 0; v < map.size(); ++v)
    EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), expected[v], 1e-12) << v;
}

TEST(ExactMap, KnowsTargetsAsThePlaneDoes) {
  const Mesh mesh = sliver_square(300);
  const Polyhedron solid(mesh);
  std::mt19937_64 random(5);
  exact::ExactOptions options;
  for (int k = 0; k < 200; ++k) options.targets.push_back(random_point(solid.surface, random));
  const exact::MeshPoint source = random_point(solid.surface, random);
  const ExactMap map = exact::exact_map(solid.surface, source, options);
  const Vec3 x = solid.position({source.face, {1, 0, 0}}), y = solid.position({source.face, {0, 1, 0}});
  for (std::size_t k = 0; k < options.targets.size(); ++k) {
    const Vec3 p = solid.position(source), q = solid.position(options.targets[k]);
    EXPECT_NEAR(map.target_distance(k), distance(p, q), 1e-12);
    double ahead = 0;
    for (int a = 0; a < 3; ++a) ahead += (y[a] - x[a]) * (q[a] - p[a]) / distance(x, y);
    EXPECT_NEAR(map.target_coordinates(k)[0], ahead, 1e-11);
  }
}

}  // namespace
}  // namespace ahm::test
