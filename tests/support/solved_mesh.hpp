/// \file
/// Maps of a triangle mesh, and their errors if the mesh is a plane.
#pragma once

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {

/// A surface with its solver.
struct SolvedMesh {
  explicit SolvedMesh(const Mesh& mesh, const trimesh::MeshOptions& options = {})
      : surface(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, options)), solver(surface.graph()) {}

  RowLogMap map(const Source& source, Variant variant = Variant::adaptive) const {
    return surface.to_rows(solver.solve(source, {.variant = variant}));
  }
  RowLogMap map(const SurfacePoint& point, Variant variant = Variant::adaptive) const {
    return map(surface.source(point).source, variant);
  }
  RowLogMap map(const SurfacePoint& point, const Vec3& axis, Variant variant = Variant::adaptive) const {
    return map(surface.source(point, axis).source, variant);
  }

  trimesh::TriangleMeshSurface surface;
  LogMapSolver solver;
};

/// Largest distance between the map and the coordinates in the plane, with origin `origin` and unit axis `axis`. Infinite if a vertex
/// is not mapped.
inline double plane_error(const Mesh& mesh, const RowLogMap& map, const Vec2& origin, const Vec2& axis) {
  return plane_error(mesh.plane, map.u, map.v, origin, axis);
}

inline Vec2 plane_point(const Mesh& mesh, const FacePoint& point) {
  return mesh.plane_point(point.face, {point.barycentric[0], point.barycentric[1], point.barycentric[2]});
}

}  // namespace ahm::test
