/// \file
/// Flat meshes with arbitrarily thin faces.
#pragma once

#include "meshes.hpp"

namespace ahm::test {

/// Adds vertices to a flat mesh, each in a face or at an edge that is not changed yet. A needle is a vertex next to another one
/// on an edge of it. A cap is a vertex next to an edge, inside a face.
/// @param thinness  of needles: short side over long side; of caps: height over side. 0: coincident vertices, faces without height
class Thinner {
 public:
  Thinner(Mesh mesh, unsigned seed) : mesh_(std::move(mesh)), changed_(mesh_.faces.size(), false), random_(seed) {}

  void add_needle(double thinness) {
    const auto f = unchanged_face();
    const auto [a, b, c] = rotated(mesh_.faces[f], random_() % 3);
    const Index m = add_vertex(a, b, thinness);
    changed_[f] = true;
    for (std::size_t g = 0; g < changed_.size(); ++g)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [to, from, d] = rotated(mesh_.faces[g], k);
        if (to != b || from != a) continue;
        changed_[g] = true;
        mesh_.faces[g] = {m, a, d};
        append({b, m, d});
        k = 3;
      }
    mesh_.faces[f] = {a, m, c};
    append({m, b, c});
  }

  void add_cap(double thinness) {
    const auto f = unchanged_face();
    const auto [a, b, c] = rotated(mesh_.faces[f], random_() % 3);
    const Index m = add_vertex(a, b, 0.3 + 0.4 * (static_cast<double>(random_() >> 11) * 0x1p-53));
    mesh_.plane[m] = mesh_.plane[m] + thinness * (mesh_.plane[c] - mesh_.plane[m]);
    changed_[f] = true;
    mesh_.faces[f] = {a, b, m};
    append({b, c, m});
    append({c, a, m});
  }

  const Mesh& mesh() const { return mesh_; }

 private:
  static Triangle rotated(const Triangle& t, std::size_t s) { return {t[s], t[(s + 1) % 3], t[(s + 2) % 3]}; }
  std::size_t unchanged_face() {
    for (;;)
      if (const std::size_t f = random_() % mesh_.faces.size(); !changed_[f]) return f;
  }
  Index add_vertex(Index a, Index b, double t) {
    mesh_.plane.push_back(mesh_.plane[a] + t * (mesh_.plane[b] - mesh_.plane[a]));
    return static_cast<Index>(mesh_.plane.size() - 1);
  }
  void append(const Triangle& t) {
    mesh_.faces.push_back(t);
    changed_.push_back(true);
  }

  Mesh mesh_;
  std::vector<bool> changed_;
  std::mt19937_64 random_;
};

/// A jittered square with `count` needles and caps of each thinness.
/// @param tilted  in a plane in general position, where every coordinate is rounded; else z = 0
inline Mesh thin_square(Index side, const std::vector<double>& thinness, int count, bool tilted, unsigned seed = 1) {
  Thinner thinner(flat_square(side, 0.24, seed), seed);
  for (double thin : thinness)
    for (int k = 0; k < count; ++k) thinner.add_needle(thin), thinner.add_cap(thin);
  Mesh mesh = at_plane(thinner.mesh());
  if (tilted)
    for (Vec3& p : mesh.positions) p = {(2 * p[0] + 2 * p[1]) / 3, (2 * p[1] - p[0]) / 3, (2 * p[0] - p[1]) / 3};
  return mesh;
}

struct Place {
  std::string name;
  SurfacePoint point;
  Vec2 plane;
};

/// Rows, points in faces and points on edges, including thin ones.
inline std::vector<Place> places(const Mesh& mesh) {
  std::vector<Place> result;
  const Index n = mesh.vertices(), faces = static_cast<Index>(mesh.faces.size());
  for (Index v : {0, n / 3, n - 1, n - 2, n - 7}) result.push_back({"row " + std::to_string(v), Row(v), mesh.plane[v]});
  for (Index f : {7, faces / 2, faces - 1, faces - 2, faces - 12, faces - 13}) {
    const std::string name = "face " + std::to_string(f);
    result.push_back({name, FacePoint{f, {0.3, 0.5, 0.2}}, mesh.plane_point(f, {0.3, 0.5, 0.2})});
    for (int s = 0; s < 3; ++s) {
      const Index a = mesh.faces[f][s], b = mesh.faces[f][(s + 1) % 3];
      result.push_back({"edge of " + name, EdgePoint{Row(a), Row(b), 0.3}, 0.7 * mesh.plane[a] + 0.3 * mesh.plane[b]});
    }
  }
  return result;
}

}  // namespace ahm::test
