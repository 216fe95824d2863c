/// \file
/// Generated clouds and meshes for the benchmarks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::bench {

/// Points of the unit sphere at random.
inline std::vector<Vec3> random_sphere(Index n) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (Index i = 0; i < n; ++i) {
    Vec3 p{normal(random), normal(random), normal(random)};
    const double r = std::hypot(p[0], p[1], p[2]);
    points.push_back({p[0] / r, p[1] / r, p[2] / r});
  }
  return points;
}

/// Points of the unit sphere on a golden spiral: evenly spread.
inline std::vector<Vec3> even_sphere(Index n) {
  std::vector<Vec3> points;
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = std::sqrt(1.0 - z * z), turn = i * 2.39996322972865332;
    points.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  return points;
}

struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> faces;
};

/// A torus of radii 1 and 0.4, about n vertices, jittered along the surface, its quads cut at random.
inline Mesh torus(Index n) {
  const auto around = static_cast<Index>(std::sqrt(2.5 * n)), across = n / around;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  Mesh mesh;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * (i + jitter(random)) / around,
                   v = 2 * std::numbers::pi * (j + jitter(random)) / across, r = 1 + 0.4 * std::cos(v);
      mesh.points.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
    }
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      auto at = [&](Index x, Index y) { return x % around * across + y % across; };
      const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (random() % 2) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
  return mesh;
}

/// An icosahedron whose faces were split in four until there are at least n vertices: 10 4^s + 2.
inline Mesh icosphere(Index n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                           {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<Index, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  auto to_sphere = [](Vec3 p) {
    const double r = std::hypot(p[0], p[1], p[2]);
    return Vec3{p[0] / r, p[1] / r, p[2] / r};
  };
  for (Vec3& p : points) p = to_sphere(p);
  while (static_cast<Index>(points.size()) < n) {
    std::map<std::pair<Index, Index>, Index> middles;
    auto middle = [&](Index a, Index b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(points.size()));
      if (is_new) {
        const Vec3 p = points[a], q = points[b];
        points.push_back(to_sphere({p[0] + q[0], p[1] + q[1], p[2] + q[2]}));
      }
      return entry->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) finer.push_back(face);
    }
    faces = std::move(finer);
  }
  return {std::move(points), std::move(faces)};
}

}  // namespace ahm::bench
