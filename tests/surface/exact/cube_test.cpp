#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "polyhedra.hpp"

namespace ahm::test {
namespace {

/// The unit cube, every side cut into parts x parts squares of two triangles.
Mesh cube(Index parts) {
  Mesh mesh;
  std::map<std::array<Index, 3>, Index> number;
  auto vertex = [&](std::array<Index, 3> p) {
    const auto [at, fresh] = number.try_emplace(p, static_cast<Index>(mesh.positions.size()));
    if (fresh)
      mesh.positions.push_back(
          {p[0] / static_cast<double>(parts), p[1] / static_cast<double>(parts), p[2] / static_cast<double>(parts)});
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (Index side : {0, parts})
      for (Index i = 0; i < parts; ++i)
        for (Index j = 0; j < parts; ++j) {
          auto corner = [&](Index a, Index b) {
            std::array<Index, 3> p;
            p[axis] = side, p[(axis + 1) % 3] = i + a, p[(axis + 2) % 3] = j + b;
            return vertex(p);
          };
          const Index a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          mesh.faces.push_back(side > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
          mesh.faces.push_back(side > 0 ? Triangle{a, c, d} : Triangle{a, d, c});
        }
  return mesh;
}

/// The unit cube, four of its sides cut into needles that run across it: rows of vertices in a line, as CAD has them.
Mesh needle_cube(Index strips) {
  Mesh mesh;
  const double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (Index i = 0; i <= strips; ++i)
    for (const auto& c : corner) mesh.positions.push_back({static_cast<double>(i) / strips, c[0], c[1]});
  for (Index i = 0; i < strips; ++i)
    for (Index k = 0; k < 4; ++k) {
      const Index a = 4 * i + k, b = 4 * i + (k + 1) % 4, c = b + 4, d = a + 4;
      mesh.faces.push_back({a, c, b});
      mesh.faces.push_back({a, d, c});
    }
  const Index end = 4 * strips;
  mesh.faces.insert(mesh.faces.end(), {{0, 1, 2}, {0, 2, 3}, {end, end + 2, end + 1}, {end, end + 3, end + 2}});
  return mesh;
}

/// By some angle about every axis: no coordinate is a round number afterwards.
Vec3 turned_in_space(Vec3 p) {
  for (int k = 0; k < 3; ++k) {
    const double c = std::cos(0.3 + k), s = std::sin(0.3 + k), x = p[k], y = p[(k + 1) % 3];
    p[k] = c * x - s * y;
    p[(k + 1) % 3] = s * x + c * y;
  }
  return p;
}

double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 axis_vector(int axis, double sign) {
  Vec3 v{0, 0, 0};
  v[axis] = sign;
  return v;
}

/// Distance on the cube by rolling it over its edges without touching a side twice; side 2 k + s is x_k = s.
class RollingCube {
 public:
  double distance(const Vec3& from, const Vec3& to) {
    best_ = 1e300;
    to_ = to;
    for (int side = 0; side < 6; ++side)
      if (from[side / 2] == side % 2) {
        const Vec3 x = axis_vector((side / 2 + 1) % 3, 1), y = axis_vector((side / 2 + 2) % 3, 1);
        roll(side, 1u << side, from, x, y, {dot3(from, x), dot3(from, y)}, {});
      }
    return best_;
  }

 private:
  struct Gate {
    Vec2 a, b;
  };
  /// The side lies in the plane: a point p of it at place + ((p - origin) . x, (p - origin) . y).
  void roll(int side, unsigned seen, const Vec3& origin, const Vec3& x, const Vec3& y, const Vec2& place,
            std::vector<Gate> gates) {
    auto flat = [&](const Vec3& p) {
      const Vec3 d{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
      return Vec2{place[0] + dot3(d, x), place[1] + dot3(d, y)};
    };
    if (gates.empty()) start_ = place;
    if (to_[side / 2] == side % 2) {
      const Vec2 end = flat(to_);
      if (passes(end, gates)) best_ = std::min(best_, std::hypot(end[0] - start_[0], end[1] - start_[1]));
    }
    for (int other = 0; other < 6; ++other) {
      if ((seen >> other & 1u) != 0 || other / 2 == side / 2) continue;
      Vec3 a{0, 0, 0}, b{0, 0, 0};
      const int along = 3 - side / 2 - other / 2;
      a[side / 2] = b[side / 2] = side % 2;
      a[other / 2] = b[other / 2] = other % 2;
      b[along] = 1;
      const Vec2 a2 = flat(a), b2 = flat(b);
      // Outwards over the edge in this side becomes inwards in the other: the direction in which x_(side) leaves.
      const Vec3 outwards = axis_vector(other / 2, other % 2 ? 1 : -1),
                 inwards = axis_vector(side / 2, side % 2 ? -1 : 1);
      const Vec2 out{dot3(outwards, x), dot3(outwards, y)}, run{b2[0] - a2[0], b2[1] - a2[1]};
      Vec3 new_x, new_y;
      for (int k = 0; k < 3; ++k) {
        const double t = k == along ? 1 : 0;
        new_x[k] = run[0] * t + out[0] * inwards[k];
        new_y[k] = run[1] * t + out[1] * inwards[k];
      }
      auto further = gates;
      further.push_back({a2, b2});
      roll(other, seen | 1u << other, a, new_x, new_y, a2, further);
    }
  }
  bool passes(const Vec2& end, const std::vector<Gate>& gates) const {
    auto side_of = [&](const Vec2& p) {
      return (end[0] - start_[0]) * (p[1] - start_[1]) - (end[1] - start_[1]) * (p[0] - start_[0]);
    };
    return std::all_of(gates.begin(), gates.end(), [&](const Gate& g) {
      const double a = side_of(g.a), b = side_of(g.b);
      return std::min(a, b) <= 1e-12 && std::max(a, b) >= -1e-12;
    });
  }

  double best_ = 0;
  Vec3 to_{};
  Vec2 start_{};
};

TEST(ExactMap, AgreesWithTheRolledCube) {
  const Mesh mesh = cube(5);
  const Polyhedron solid(mesh);
  const double unit = solid.mesh.length_unit();
  RollingCube rolling;
  for (Index source : {0, 3, 17, 40, 88}) {
    const exact::ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(source)));
    for (Index v = 0; v < map.size(); ++v)
      EXPECT_NEAR(map.distance(Vertex(v)) * unit, rolling.distance(mesh.positions[source], mesh.positions[v]), 1e-12)
          << source << ' ' << v;
  }
}

TEST(ExactMap, AgreesWithTheRolledCubeInNeedles) {
  for (Index strips : {7, 60}) {
    const Mesh mesh = needle_cube(strips);
    Mesh turned = mesh;
    for (Vec3& p : turned.positions) p = turned_in_space(p);
    const Polyhedron solid(turned);
    const double unit = solid.mesh.length_unit();
    std::mt19937_64 random(6);
    exact::ExactOptions options;
    for (int k = 0; k < 60; ++k) options.targets.push_back(random_point(solid.surface, random));
    // Inside faces the plane of a side is met by rounding only.
    auto on_cube = [&](const exact::MeshPoint& point) {
      Vec3 p{0, 0, 0};
      const Triangle& face = mesh.faces[point.face];
      for (int s = 0; s < 3; ++s)
        for (int a = 0; a < 3; ++a)
          p[a] += point.barycentric[solid.mesh.stored_corner(point.face, s)] * mesh.positions[face[s]][a];
      for (double& x : p) x = std::abs(x) < 1e-14 ? 0 : std::abs(x - 1) < 1e-14 ? 1 : x;
      return p;
    };
    RollingCube rolling;
    for (int trial = 0; trial < 12; ++trial) {
      const exact::MeshPoint source =
          trial < 4 ? solid.surface.vertex_point(Vertex(5 * trial + 1)) : options.targets[trial];
      const exact::ExactMap map = exact::exact_map(solid.surface, source, options);
      for (Index v = 0; v < map.size(); ++v) {
        EXPECT_NEAR(map.distance(Vertex(v)) * unit, rolling.distance(on_cube(source), mesh.positions[v]), 1e-12);
        const exact::GeodesicPath path = exact::path_to_vertex(solid.surface, map, Vertex(v));
        EXPECT_NEAR(solid.length(path.points), path.length, 1e-12) << strips << ' ' << trial << ' ' << v;
      }
      for (std::size_t k = 0; k < map.targets(); ++k) {
        EXPECT_NEAR(map.target_distance(k) * unit, rolling.distance(on_cube(source), on_cube(options.targets[k])),
                    1e-12);
        const exact::GeodesicPath path = exact::path_to_target(solid.surface, map, k);
        EXPECT_NEAR(solid.length(path.points), path.length, 1e-12) << strips << ' ' << trial << ' ' << k;
      }
    }
  }
}

TEST(ExactMap, IsMadeOfRealPathsOnNeedlesOfRoundedCoordinates) {
  // Rows of vertices that are in a line but for the last digits of single precision.
  for (Index strips : {7, 60}) {
    Mesh mesh = needle_cube(strips);
    for (Vec3& p : mesh.positions) {
      p = turned_in_space({p[0], 0.3 * p[1], 0.7 * p[2]});
      for (double& x : p) x = static_cast<float>(x);
    }
    const Polyhedron solid(mesh);
    std::mt19937_64 random(8);
    for (int trial = 0; trial < 30; ++trial) {
      const exact::MeshPoint p =
          trial < 10 ? solid.surface.vertex_point(Vertex(trial)) : random_point(solid.surface, random);
      const exact::MeshPoint q = random_point(solid.surface, random);
      const exact::GeodesicPath there = exact::geodesic_path(solid.surface, p, q),
                                back = exact::geodesic_path(solid.surface, q, p);
      EXPECT_NEAR(there.length, back.length, 1e-12) << strips << ' ' << trial;
      EXPECT_NEAR(solid.length(there.points), there.length, 1e-12) << strips << ' ' << trial;
      const exact::ExactMap map = exact::exact_map(solid.surface, p);
      for (Index v = 0; v < map.size(); ++v)
        EXPECT_NEAR(solid.length(exact::path_to_vertex(solid.surface, map, Vertex(v)).points), map.distance(Vertex(v)),
                    1e-12);
    }
  }
}

TEST(ExactMap, ReachesTheOppositeCornerOfACubeLast) {
  const Polyhedron solid(cube(4));
  const exact::ExactMap map = exact::exact_map(solid.surface, solid.surface.vertex_point(Vertex(0)));
  double farthest = 0;
  for (Index v = 0; v < map.size(); ++v)
    farthest = std::max(farthest, map.distance(Vertex(v)) * solid.mesh.length_unit());
  EXPECT_NEAR(farthest, std::sqrt(5.0), 1e-13);
}

}  // namespace
}  // namespace ahm::test
