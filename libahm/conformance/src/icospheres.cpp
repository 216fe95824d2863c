#include <algorithm>
#include <map>
#include <utility>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "icosahedron.hpp"

namespace ahm::test {

Mesh icosphere(Index parts) {
  const auto corner = icosahedron_corners();
  Mesh mesh;
  std::map<std::array<long, 3>, Index> vertex_of_point;
  auto vertex = [&](const Triangle& t, Index i, Index j) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = (corner[t[0]][a] * (parts - i - j) + corner[t[1]][a] * i + corner[t[2]][a] * j) / parts;
    const double r = norm(p);
    for (double& x : p) x /= r;
    const std::array<long, 3> key{std::lround(p[0] * 1e9), std::lround(p[1] * 1e9), std::lround(p[2] * 1e9)};
    const auto [at, added] = vertex_of_point.try_emplace(key, mesh.vertices());
    if (added) mesh.positions.push_back(p);
    return at->second;
  };
  for (const Triangle& t : icosahedron_faces)
    for (Index i = 0; i < parts; ++i)
      for (Index j = 0; i + j < parts; ++j) {
        mesh.faces.push_back({vertex(t, i, j), vertex(t, i + 1, j), vertex(t, i, j + 1)});
        if (i + j + 1 < parts)
          mesh.faces.push_back({vertex(t, i + 1, j), vertex(t, i + 1, j + 1), vertex(t, i, j + 1)});
      }
  return mesh;
}

Mesh split_icosphere(Index n) {
  const auto corners = icosahedron_corners();
  std::vector<Vec3> points(corners.begin(), corners.end());
  std::vector<Triangle> faces(icosahedron_faces.begin(), icosahedron_faces.end());
  for (Vec3& p : points) p = unit(p);
  while (static_cast<Index>(points.size()) < n) {
    std::map<std::pair<Index, Index>, Index> middles;
    auto middle = [&](Index a, Index b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(points.size()));
      if (is_new) {
        const Vec3 p = points[a], q = points[b];
        points.push_back(unit({p[0] + q[0], p[1] + q[1], p[2] + q[2]}));
      }
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) finer.push_back(face);
    }
    faces = std::move(finer);
  }
  return {std::move(points), std::move(faces), {}};
}

}  // namespace ahm::test
