/// \file
/// Surfaces with maps known exactly, for the tests of what is built on maps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "ahm/applications/inverse_map.hpp"
#include "ahm/conformance/vectors.hpp"

namespace ahm::test {

/// A jittered grid over a square of the (u, v) plane and where each of its vertices lies in space.
struct Patch {
  std::vector<double> coordinates;
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> valid;
  std::vector<Triangle> triangles;
  double longest_edge = 0;  ///< in the plane

  MappedSurface surface() const { return {positions, normals, coordinates, valid, triangles}; }
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

/// The square [-half, half]^2 with `side` vertices each way, moved by up to a fifth of the spacing, diagonals at random.
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
      p.coordinates.insert(p.coordinates.end(), {u, v});
      p.positions.push_back(position);
      p.normals.push_back(normal);
      p.valid.push_back(1);
    }
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const Index a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      if (random() % 2 == 0)
        p.triangles.push_back({a, b, d}), p.triangles.push_back({a, d, c});
      else
        p.triangles.push_back({a, b, c}), p.triangles.push_back({b, d, c});
    }
  for (const Triangle& t : p.triangles)
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(t[c]), j = static_cast<std::size_t>(t[(c + 1) % 3]);
      p.longest_edge = std::max(p.longest_edge, std::hypot(p.coordinates[2 * i] - p.coordinates[2 * j],
                                                           p.coordinates[2 * i + 1] - p.coordinates[2 * j + 1]));
    }
  return p;
}

inline double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The same points for every test: `count` of them in the disc about the origin.
inline std::vector<std::array<double, 2>> points_in_disc(double radius, int count) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-radius, radius);
  std::vector<std::array<double, 2>> result;
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
      strip.positions.push_back({x, 0.05 * row, 0});
      strip.normals.push_back({0, 0, 1});
      strip.coordinates.insert(strip.coordinates.end(), {u, 0.05 * row});
      strip.valid.push_back(1);
    }
  for (Index k = 0; k + 1 < columns; ++k) {
    strip.triangles.push_back({k, k + 1, k + 1 + columns});
    strip.triangles.push_back({k, k + 1 + columns, k + columns});
  }
  return strip;
}

}  // namespace ahm::test
