// Exact maps on surfaces where shortest paths are known otherwise: planes, unrolled cones, tubes and bands, a rolled cube.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>

#include "ahm/conformance/paper_band.hpp"
#include "polyhedra.hpp"

namespace ahm::test {
namespace {

using exact::ExactMap;
using exact::MeshPoint;
using exact::PolyhedralSurface;
using std::numbers::pi;

/// Expects the distance of each vertex, world units.
void expect_distances(const Polyhedron& solid, const ExactMap& map, const std::function<double(Index)>& expected,
                      double tolerance = 1e-12) {
  for (Index v = 0; v < map.size(); ++v)
    EXPECT_NEAR(map.distance(Vertex(v)) * solid.mesh.length_unit(), expected(v), tolerance) << "vertex " << v;
}

// ------------------------------------------------------------------------------------------------ planes

TEST(ExactMap, IsThePlaneOnFlatMeshes) {
  for (const Mesh& mesh : {sliver_square(600, 1), sliver_square(600, 2), sliver_square(600, 3), folded_strip(15)}) {
    const Polyhedron solid(mesh);
    for (Index source : {0, 5, 77, 112, 200}) {
      const ExactMap map = solid.map(source);
      std::vector<double> u, v;
      for (Index i = 0; i < map.size(); ++i) {
        const Vec2 uv = solid.mesh.length_unit() * map.coordinates(Vertex(i));
        u.push_back(uv[0]), v.push_back(uv[1]);
      }
      const Vec2 ahead = mesh.plane[solid.surface.record(solid.surface.first_corner(source).half).head];
      EXPECT_LT(plane_error(mesh.plane, u, v, mesh.plane[source], normalized(ahead - mesh.plane[source])), 1e-12);
    }
  }
}

TEST(ExactMap, TargetsAreThoseOfThePlane) {
  const Polyhedron solid(sliver_square(300));
  std::mt19937_64 random(5);
  exact::ExactOptions options;
  options.targets = random_points(solid.surface, 200, random);
  const MeshPoint source = random_point(solid.surface, random);
  const ExactMap map = exact::exact_map(solid.surface, source, options);
  const Vec3 p = solid.position(source),
             axis = normalized(solid.position({source.face, {0, 1, 0}}) - solid.position({source.face, {1, 0, 0}}));
  for (std::size_t k = 0; k < options.targets.size(); ++k) {
    const Vec3 q = solid.position(options.targets[k]);
    EXPECT_NEAR(map.target_distance(k), distance(p, q), 1e-12);
    EXPECT_NEAR(map.target_coordinates(k)[0], dot(axis, q - p), 1e-11);
  }
}

/// Shortest paths in a flat mesh with holes: straight lines between vertices of the boundary that do not cross it.
class VisibilityGraph {
 public:
  VisibilityGraph(const Mesh& mesh, const PolyhedralSurface& surface) : mesh_(mesh), bends_(mesh.plane.size(), false) {
    for (exact::Half h = 0; h < 3 * surface.face_count(); ++h)
      if (surface.record(exact::next(h)).beyond_left < 0) {  // side h is the left side of the next half-edge
        const auto [a, b] = sides_.emplace_back(std::array{surface.record(h).tail, surface.record(h).head});
        bends_[a] = bends_[b] = true;
      }
  }

  std::vector<double> distances(Index source) const {
    std::vector<double> d(bends_.size(), HUGE_VAL);
    d[source] = 0;
    for (std::deque<Index> changed{source}; !changed.empty(); changed.pop_front()) {
      const Vec2& p = mesh_.plane[changed.front()];
      for (Index v = 0; v < mesh_.vertices(); ++v) {
        const double through = d[changed.front()] + norm(mesh_.plane[v] - p);
        if (!(through < d[v]) || !is_visible(p, mesh_.plane[v])) continue;
        d[v] = through;
        if (bends_[v]) changed.push_back(v);
      }
    }
    return d;
  }

 private:
  bool is_visible(const Vec2& p, const Vec2& q) const {
    const auto are_opposite = [](double a, double b) { return std::min(a, b) < -1e-14 && std::max(a, b) > 1e-14; };
    for (const auto& [i, j] : sides_) {
      const Vec2 &a = mesh_.plane[i], &b = mesh_.plane[j];
      if (are_opposite(cross(q - p, a - p), cross(q - p, b - p)) &&
          are_opposite(cross(b - a, p - a), cross(b - a, q - a)))
        return false;
    }
    return std::ranges::any_of(mesh_.faces, [&, middle = 0.5 * (p + q)](const Triangle& t) {
      return std::ranges::all_of(std::array{0, 1, 2}, [&](int s) {
        const Vec2 &a = mesh_.plane[t[s]], &b = mesh_.plane[t[(s + 1) % 3]];
        return cross(b - a, middle - a) > -1e-14;
      });
    });
  }

  const Mesh& mesh_;
  std::vector<std::array<Index, 2>> sides_;
  std::vector<bool> bends_;
};

TEST(ExactMap, BendsAroundHolesAndCorners) {
  for (const Mesh& mesh : {holed_square(14, 1), holed_square(14, 2), maze(3)}) {
    const Polyhedron solid(mesh);
    const VisibilityGraph graph(mesh, solid.surface);
    for (Index source : {0, mesh.vertices() / 5, mesh.vertices() / 2}) {
      const std::vector<double> expected = graph.distances(source);
      expect_distances(solid, solid.map(source), [&](Index v) { return expected[v]; });
    }
  }
}

// ------------------------------------------------------------------------------------------------ unrolled surfaces

TEST(ExactMap, UnrollsCones) {
  for (double angle : {2.5, 5.0, 7.0, 9.5}) {
    SCOPED_TRACE(angle);
    const PolarCone cone(angle, 24, 6);
    const Polyhedron solid(cone.mesh());
    for (Index source : {0, 30, 100})
      expect_distances(solid, solid.map(source), [&](Index v) { return cone.distance(source, v); });
    const ExactMap map = solid.map(0);  // angles around the apex are scaled to a full turn
    for (Index v = 1; v < map.size(); ++v) {
      const double expected = map.direction(Vertex(1)) + cone.polar[v][1] * 2 * pi / angle;
      EXPECT_NEAR(std::remainder(map.direction(Vertex(v)) - expected, 2 * pi), 0, 1e-12);
    }
  }
}

// Rays next to a row of vertices miss each vertex only by the rounding of their angles, and the tube has hundreds of rows.
TEST(ExactMap, GoesFarAlongTubes) {
  const Index around = 40, rings = 900;
  const double radius = around / (2 * pi), side = 2 * radius * std::sin(pi / around);
  const Polyhedron tube(triangles(quads(rings, around, Columns::closed, [&](Index j, Index i) {
    const double angle = 2 * pi * i / around;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(j)};
  })));
  for (const Index source : {12, 20})
    expect_distances(
        tube, tube.map(source),
        [&](Index v) {
          const Index apart = std::abs(v % around - source % around);
          return std::hypot(side * std::min(apart, around - apart), v / around - source / around);
        },
        1e-9);
}

/// The vector from p to the nearest image of q in the strip that the band was glued from.
Vec2 vector_in_band(const Vec2& p, const Vec2& q) {
  Vec2 nearest = q - p;
  for (double turn : {-1.0, 1.0})
    if (const Vec2 image{q[0] + turn - p[0], 0.2 - q[1] - p[1]}; norm(image) < norm(nearest)) nearest = image;
  return nearest;
}

double angle_between(const Vec2& a, const Vec2& b) { return std::atan2(cross(a, b), dot(a, b)); }

TEST(ExactMap, PassesTheTwistOfAPaperBand) {
  const PaperBand band = paper_band(30, 5);
  const Polyhedron solid(
      trimesh::TriangleMesh::from_edge_lengths(static_cast<Index>(band.plane.size()), band.faces, band.lengths));
  ASSERT_FALSE(solid.mesh.report().orientable);
  for (Index source = 0; source < solid.surface.vertex_count(); source += 4) {
    SCOPED_TRACE(source);
    const ExactMap map = solid.map(source);
    const auto vector = [&](Index v) { return vector_in_band(band.plane[source], band.plane[v]); };
    expect_distances(solid, map, [&](Index v) { return norm(vector(v)); });
    const exact::Corner first = solid.surface.first_corner(source);
    const auto& r = solid.surface.record(first.half);
    const Vec2 right = vector(first.forward ? r.head : r.apex), left = vector(first.forward ? r.apex : r.head);
    const double sense = angle_between(right, left) > 0 ? 1 : -1;
    for (Index v = 0; v < map.size(); ++v)
      if (v != source)
        EXPECT_NEAR(std::remainder(map.direction(Vertex(v)) - sense * angle_between(right, vector(v)), 2 * pi), 0,
                    1e-11)
            << "vertex " << v;
  }
}

// A cone of one triangle: two of its sides have length 1 and are glued to each other.
TEST(ExactMap, CrossesTheGluedSidesOfOneTriangle) {
  constexpr std::array<Index, 3> tails{0, 1, 1};
  constexpr std::array<exact::Half, 3> twins{2, -1, 0};
  for (double angle : {0.4, 1.0, 2.0, 2.9}) {
    const std::array<std::array<double, 3>, 1> lengths{{{1.0, 2 * std::sin(angle / 2), 1.0}}};
    const auto cone = PolyhedralSurface::from_lengths({tails, twins}, lengths);
    const auto place = [&](const MeshPoint& p, double turn) {  // of its image turned around the apex
      const auto& [apex, first, second] = p.barycentric;
      return Vec2{first * std::cos(turn) + second * std::cos(angle + turn),
                  first * std::sin(turn) + second * std::sin(angle + turn)};
    };
    std::mt19937_64 random(3);
    for (int k = 0; k < 100; ++k) {
      const MeshPoint p = random_point(cone, random), q = random_point(cone, random);
      double least = HUGE_VAL;
      for (double turn : {-angle, 0.0, angle}) least = std::min(least, norm(place(p, 0) - place(q, turn)));
      EXPECT_NEAR(exact::geodesic_path(cone, p, q).length, least, 1e-13) << angle;
    }
  }
}

// ------------------------------------------------------------------------------------------------ cubes

/// The unit cube. Four of its sides are cut into needles that run across it: rows of vertices on a line, as in CAD meshes.
Mesh needle_cube(Index strips) {
  const std::array<Vec2, 4> corner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  Mesh mesh = triangles(quads(strips + 1, 4, Columns::closed, [&](Index i, Index k) {
    return Vec3{static_cast<double>(i) / strips, corner[k][0], corner[k][1]};
  }));
  for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
  const Index end = 4 * strips;
  mesh.faces.insert(mesh.faces.end(), {{0, 1, 2}, {0, 2, 3}, {end, end + 2, end + 1}, {end, end + 3, end + 2}});
  return mesh;
}

/// Rotated around each axis, so that no coordinate is a round number.
Vec3 rotated(Vec3 p) {
  for (int k = 0; k < 3; ++k) {
    const double c = std::cos(0.3 + k), s = std::sin(0.3 + k), x = p[k], y = p[(k + 1) % 3];
    p[k] = c * x - s * y;
    p[(k + 1) % 3] = s * x + c * y;
  }
  return p;
}

/// Distances on the unit cube, found by rolling it over its edges without touching a side twice. Side 2 k + s is x_k = s.
class RollingCube {
 public:
  double distance(const Vec3& from, const Vec3& to) {
    best_ = HUGE_VAL;
    to_ = to;
    for (int side = 0; side < 6; ++side)
      if (from[side / 2] == side % 2)
        roll(side, 1u << side, from, along((side / 2 + 1) % 3), along((side / 2 + 2) % 3), {0, 0});
    return best_;
  }

 private:
  static Vec3 along(int axis, double sign = 1) {
    Vec3 v{0, 0, 0};
    v[axis] = sign;
    return v;
  }
  /// A point p of the side is at place + ((p - origin) . x, (p - origin) . y) in the plane; the path starts at (0, 0).
  void roll(int side, unsigned visited, const Vec3& origin, const Vec3& x, const Vec3& y, const Vec2& place) {
    const auto flat = [&](const Vec3& p) { return place + Vec2{dot(p - origin, x), dot(p - origin, y)}; };
    if (to_[side / 2] == side % 2)
      if (const Vec2 end = flat(to_); passes_gates(end)) best_ = std::min(best_, norm(end));
    for (int other = 0; other < 6; ++other) {
      if ((visited >> other & 1u) != 0 || other / 2 == side / 2) continue;
      const Vec3 edge = along(3 - side / 2 - other / 2), a = side % 2 * along(side / 2) + other % 2 * along(other / 2);
      // The direction that leaves this side at the edge is the direction that enters the other side.
      const Vec3 outward = along(other / 2, other % 2 ? 1 : -1), inward = along(side / 2, side % 2 ? -1 : 1);
      const Vec3 next_x = dot(edge, x) * edge + dot(outward, x) * inward,
                 next_y = dot(edge, y) * edge + dot(outward, y) * inward;
      gates_.push_back({flat(a), flat(a + edge)});
      roll(other, visited | 1u << other, a, next_x, next_y, flat(a));
      gates_.pop_back();
    }
  }
  /// Whether the straight line to `end` crosses all edges that the cube was rolled over.
  bool passes_gates(const Vec2& end) const {
    return std::ranges::all_of(gates_, [&](const std::array<Vec2, 2>& gate) {
      const double a = cross(end, gate[0]), b = cross(end, gate[1]);
      return std::min(a, b) <= 1e-12 && std::max(a, b) >= -1e-12;
    });
  }

  double best_ = 0;
  Vec3 to_{};
  std::vector<std::array<Vec2, 2>> gates_;
};

TEST(ExactMap, AgreesWithTheRolledCube) {
  EXPECT_NEAR(RollingCube().distance({0, 0, 0}, {1, 1, 1}), std::sqrt(5.0), 1e-13);
  for (const auto& [strips, is_rotated] : {std::pair(7, false), {7, true}, {60, true}}) {
    const Mesh mesh = needle_cube(strips);
    Mesh shown = mesh;
    if (is_rotated)
      for (Vec3& p : shown.positions) p = rotated(p);
    const Polyhedron solid(shown);
    std::mt19937_64 random(6);
    exact::ExactOptions options;
    options.targets = random_points(solid.surface, 60, random);
    const auto on_cube = [&](const MeshPoint& point) {
      Vec3 p{0, 0, 0};
      for (int s = 0; s < 3; ++s)
        p = p + point.barycentric[solid.mesh.stored_corner(point.face, s)] * mesh.positions[mesh.faces[point.face][s]];
      // The plane of the side is exact only up to rounding.
      for (double& x : p) x = std::abs(x) < 1e-14 ? 0 : std::abs(x - 1) < 1e-14 ? 1 : x;
      return p;
    };
    RollingCube rolling;
    for (int trial = 0; trial < 12; ++trial) {
      SCOPED_TRACE(testing::Message() << strips << " strips, trial " << trial);
      const MeshPoint source = trial < 4 ? solid.vertex(5 * trial + 1) : options.targets[trial];
      const ExactMap map = exact::exact_map(solid.surface, source, options);
      expect_distances(solid, map, [&](Index v) { return rolling.distance(on_cube(source), mesh.positions[v]); });
      for (Index v = 0; v < map.size(); ++v) solid.expect_length(exact::path_to_vertex(solid.surface, map, Vertex(v)));
      for (std::size_t k = 0; k < map.targets(); ++k) {
        EXPECT_NEAR(map.target_distance(k) * solid.mesh.length_unit(),
                    rolling.distance(on_cube(source), on_cube(options.targets[k])), 1e-12);
        solid.expect_length(exact::path_to_target(solid.surface, map, k));
      }
    }
  }
}

// Vertices in rows are on a line except for the last digits of single precision.
TEST(ExactMap, HasPathsOfItsDistancesInNeedlesOfRoundedCoordinates) {
  for (Index strips : {7, 60}) {
    Mesh mesh = needle_cube(strips);
    for (Vec3& p : mesh.positions) {
      p = rotated({p[0], 0.3 * p[1], 0.7 * p[2]});
      for (double& x : p) x = static_cast<float>(x);
    }
    const Polyhedron solid(mesh);
    std::mt19937_64 random(8);
    for (int trial = 0; trial < 30; ++trial) {
      SCOPED_TRACE(testing::Message() << strips << " strips, trial " << trial);
      const MeshPoint p = trial < 10 ? solid.vertex(trial) : random_point(solid.surface, random),
                      q = random_point(solid.surface, random);
      const exact::GeodesicPath path = solid.path(p, q);
      EXPECT_NEAR(path.length, solid.path(q, p).length, 1e-12);
      solid.expect_length(path);
      const ExactMap map = exact::exact_map(solid.surface, p);
      for (Index v = 0; v < map.size(); ++v)
        EXPECT_NEAR(solid.length(exact::path_to_vertex(solid.surface, map, Vertex(v)).points), map.distance(Vertex(v)),
                    1e-12);
    }
  }
}

}  // namespace
}  // namespace ahm::test
