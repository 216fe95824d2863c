/// \file
/// Surfaces with maps in closed form, and short names, for the tests of the applications.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

inline constexpr double pi = std::numbers::pi;

inline trimesh::TriangleMeshSurface mesh_surface(const Mesh& mesh) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

/// Mean edge length, world units.
inline double edge_length(const TangentGraph& graph) { return graph.mean_edge_length() * graph.length_unit(); }

/// A jittered grid over a square of the (u, v) plane and the position of each vertex in space.
struct Patch {
  std::vector<double> coordinates;
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> valid;
  std::vector<Triangle> triangles;
  double longest_edge = 0;  ///< in the plane

  MappedSurface surface() const { return {positions, normals, coordinates, valid, triangles}; }
  Vec2 plane(std::size_t i) const { return {coordinates[2 * i], coordinates[2 * i + 1]}; }
  void add(const Vec2& uv, const Vec3& position, const Vec3& normal) {
    coordinates.insert(coordinates.end(), uv.begin(), uv.end());
    positions.push_back(position);
    normals.push_back(normal);
    valid.push_back(1);
  }
  /// The patch with coordinates and positions multiplied by 2^exponent.
  Patch scaled(int exponent) const {
    Patch result = *this;
    for (double& x : result.coordinates) x = std::ldexp(x, exponent);
    for (Vec3& p : result.positions)
      for (double& x : p) x = std::ldexp(x, exponent);
    return result;
  }
};

/// Point and normal at (u, v).
using Immersion = std::function<std::array<Vec3, 2>(double u, double v)>;

inline std::array<Vec3, 2> flat(double u, double v) { return {Vec3{u, v, 0}, Vec3{0, 0, 1}}; }

/// Polar coordinates about the north pole of the unit sphere.
inline std::array<Vec3, 2> on_sphere(double u, double v) {
  const double r = std::hypot(u, v), s = r > 0 ? std::sin(r) / r : 1;
  const Vec3 p{s * u, s * v, std::cos(r)};
  return {p, p};
}

/// The square [-half, half]^2 of `side` x `side` vertices, moved by up to a fifth of the spacing, diagonals at random.
inline Patch patch(int side, double half, const Immersion& immersion) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  const double h = 2 * half / (side - 1);
  Patch p;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool border = x == 0 || y == 0 || x == side - 1 || y == side - 1;
      const double u = -half + h * (x + (border ? 0 : jitter(random))),
                   v = -half + h * (y + (border ? 0 : jitter(random)));
      const auto [position, normal] = immersion(u, v);
      p.add({u, v}, position, normal);
    }
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const Index a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      if (random() % 2 == 0)
        p.triangles.insert(p.triangles.end(), {{a, b, d}, {a, d, c}});
      else
        p.triangles.insert(p.triangles.end(), {{a, b, c}, {b, d, c}});
    }
  for (const Triangle& t : p.triangles)
    for (int c = 0; c < 3; ++c)
      p.longest_edge = std::max(p.longest_edge, length(p.plane(to_size(t[c])) - p.plane(to_size(t[(c + 1) % 3]))));
  return p;
}

/// The same points for every test: `count` of them in the disc about the origin.
inline std::vector<Vec2> points_in_disc(double radius, int count) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-radius, radius);
  std::vector<Vec2> result;
  while (static_cast<int>(result.size()) < count)
    if (const double u = uniform(random), v = uniform(random); std::hypot(u, v) <= radius) result.push_back({u, v});
  return result;
}

/// A strip whose map goes forth, back and forth again: u = 0..1, 1..0.5, 0.5..1.5 along x = 0..1, 1..1.5, 1.5..2.5.
inline Patch pleat() {
  Patch strip;
  const int columns = 51;
  for (int row : {0, 1})
    for (int k = 0; k < columns; ++k) {
      const double x = 0.05 * k, u = k <= 20 ? x : k <= 30 ? 2 - x : x - 1;
      strip.add({u, 0.05 * row}, {x, 0.05 * row, 0}, {0, 0, 1});
    }
  for (Index k = 0; k + 1 < columns; ++k)
    strip.triangles.insert(strip.triangles.end(), {{k, k + 1, k + 1 + columns}, {k, k + 1 + columns, k + columns}});
  return strip;
}

}  // namespace ahm::test
