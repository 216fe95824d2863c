/// \file
/// Flat meshes with faces as thin as one likes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ahm/conformance/triangle_meshes.hpp"

namespace ahm::test {

/// Puts vertices into a flat mesh, each into a face or at an edge that is still as it was: needles, a vertex beside another
/// one on an edge of it, and caps, a vertex beside an edge within a face.
/// @param thinness  short side over long side, and height over side; 0: coincident vertices and faces without height
class Thinner {
 public:
  Thinner(Mesh mesh, unsigned seed) : mesh_(std::move(mesh)), touched_(mesh_.faces.size(), false), random_(seed) {}

  void add_needle(double thinness) {
    const auto f = untouched();
    const int s = static_cast<int>(random_() % 3);
    const Triangle t = mesh_.faces[f];
    const Index a = t[s], b = t[(s + 1) % 3], c = t[(s + 2) % 3], m = add(a, b, thinness);
    touched_[f] = true;
    for (std::size_t g = 0; g < touched_.size(); ++g)
      for (int k = 0; k < 3; ++k) {
        const Triangle u = mesh_.faces[g];
        if (u[k] != b || u[(k + 1) % 3] != a) continue;
        touched_[g] = true;
        const Index d = u[(k + 2) % 3];
        mesh_.faces[g] = {m, a, d};
        append({b, m, d});
        k = 3;
      }
    mesh_.faces[f] = {a, m, c};
    append({m, b, c});
  }

  void add_cap(double thinness) {
    const auto f = untouched();
    const int s = static_cast<int>(random_() % 3);
    const Triangle t = mesh_.faces[f];
    const Index a = t[s], b = t[(s + 1) % 3], c = t[(s + 2) % 3], m = add(a, b, 0.3 + 0.4 * uniform());
    for (int k = 0; k < 2; ++k) mesh_.plane[m][k] += thinness * (mesh_.plane[c][k] - mesh_.plane[m][k]);
    touched_[f] = true;
    mesh_.faces[f] = {a, b, m};
    append({b, c, m});
    append({c, a, m});
  }

  /// @param tilted  in a plane in general position, where every coordinate is rounded; else z = 0
  Mesh finish(bool tilted) {
    mesh_.positions.clear();
    for (const auto& [x, y] : mesh_.plane)
      mesh_.positions.push_back(tilted ? Vec3{(2 * x + 2 * y) / 3, (2 * y - x) / 3, (2 * x - y) / 3} : Vec3{x, y, 0});
    return mesh_;
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::size_t untouched() {
    for (;;)
      if (const std::size_t f = random_() % mesh_.faces.size(); !touched_[f]) return f;
  }
  Index add(Index a, Index b, double t) {
    const Vec2 p = mesh_.plane[a], q = mesh_.plane[b];
    mesh_.plane.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    return static_cast<Index>(mesh_.plane.size() - 1);
  }
  void append(const Triangle& t) {
    mesh_.faces.push_back(t);
    touched_.push_back(true);
  }

  Mesh mesh_;
  std::vector<bool> touched_;
  std::mt19937_64 random_;
};

/// A jittered square with needles and caps of each of these degrees of thinness.
inline Mesh thin_square(Index side, const std::vector<double>& thinness, int of_each, bool tilted, unsigned seed = 1) {
  Thinner thinner(flat_square(side, 0.24, seed), seed);
  for (double thin : thinness)
    for (int k = 0; k < of_each; ++k) thinner.add_needle(thin), thinner.add_cap(thin);
  return thinner.finish(tilted);
}

}  // namespace ahm::test
