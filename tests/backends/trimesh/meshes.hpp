/// \file
/// Changes of meshes, and errors of maps of flat meshes.
#pragma once

#include "backends/surface_maps.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {

using trimesh::MeshOptions;
using trimesh::TriangleMesh;
using trimesh::TriangleMeshSurface;

inline TriangleMeshSurface build(const Mesh& mesh, const MeshOptions& options = {}) {
  return TriangleMeshSurface::build(mesh.positions, mesh.faces, options);
}

/// Scales the positions, then moves them.
inline Mesh moved(Mesh mesh, double scale, const Vec3& shift) {
  for (Vec3& p : mesh.positions) p = scale * p + shift;
  return mesh;
}

/// Sets the positions to those in the plane, with z = 0.
inline Mesh at_plane(Mesh mesh) {
  mesh.positions.clear();
  for (const auto& [x, y] : mesh.plane) mesh.positions.push_back({x, y, 0});
  return mesh;
}

/// Rings of vertices at position(ring, k), joined by quads that are all cut along the same diagonal.
/// @param is_closed  whether the last ring is joined to the first
template <class Position>
Mesh tube(Index rings, Index around, bool is_closed, const Position& position) {
  Mesh mesh;
  for (Index i = 0; i < rings; ++i)
    for (Index k = 0; k < around; ++k) {
      mesh.positions.push_back(position(i, k));
      if (!is_closed && i + 1 == rings) continue;
      const Index here = i * around, above = (i + 1) % rings * around, next = (k + 1) % around;
      mesh.faces.push_back({here + k, here + next, above + next});
      mesh.faces.push_back({here + k, above + next, above + k});
    }
  return mesh;
}

/// The mesh described by its edge lengths.
inline TriangleMesh without_positions(const Mesh& mesh) {
  std::vector<std::array<double, 3>> lengths;
  for (const Triangle& t : mesh.faces) {
    lengths.emplace_back();
    for (int s = 0; s < 3; ++s) lengths.back()[s] = distance(mesh.positions[t[s]], mesh.positions[t[(s + 1) % 3]]);
  }
  return TriangleMesh::from_edge_lengths(mesh.vertices(), mesh.faces, lengths);
}

inline FacePoint random_point(const Mesh& mesh, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto face = static_cast<Index>(random() % mesh.faces.size());
  double a = uniform(random), b = uniform(random);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  return {face, {a, b, 1 - a - b}};
}

/// The unit vector from one vertex to another in the plane.
inline Vec2 direction(const Mesh& mesh, Index from, Index to) { return normalized(mesh.plane[to] - mesh.plane[from]); }

/// Largest errors of coordinates and of distances against the plane. The u axis is that of the farthest vertex. Infinite unless
/// every row is mapped.
struct PlaneErrors {
  double coordinates, distance = 0;

  PlaneErrors(const Mesh& mesh, const RowLogMap& map, const Vec2& origin) {
    const auto away = [&](std::size_t i) { return length(mesh.plane[i] - origin); };
    std::size_t far = 0;
    for (std::size_t i = 0; i < mesh.plane.size(); ++i) {
      if (away(i) > away(far)) far = i;
      const double off = std::abs(map.distance[i] - away(i));
      distance = std::isnan(off) || map.status[i] != Status::ok ? INFINITY : std::max(distance, off);
    }
    const Vec2 exact = normalized(mesh.plane[far] - origin), found = normalized(Vec2{map.u[far], map.v[far]});
    coordinates = plane_error(mesh, map, origin, {ahm::dot(exact, found), ahm::cross(found, exact)});
  }
};

}  // namespace ahm::test
