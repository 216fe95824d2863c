/// \file
<<<<<<< HEAD
/// A triangle mesh with its graph factored, and the errors of its maps against the plane it was made from.
=======
/// Maps of a triangle mesh, and their errors if the mesh is a plane.
>>>>>>> tio
#pragma once

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {

<<<<<<< HEAD
=======
/// A surface with its solver.
>>>>>>> tio
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

<<<<<<< HEAD
/// Largest difference between (u, v) and the position in the plane relative to `origin`, with the unit axis `axis`. Infinite
/// unless every row is mapped.
=======
/// Largest distance between the map and the coordinates in the plane, with origin `origin` and unit axis `axis`. Infinite if a vertex
/// is not mapped.
>>>>>>> tio
inline double plane_error(const Mesh& mesh, const RowLogMap& map, const Vec2& origin, const Vec2& axis) {
  return plane_error(mesh.plane, map.u, map.v, origin, axis);
}

inline Vec2 plane_point(const Mesh& mesh, const FacePoint& point) {
  return mesh.plane_point(point.face, {point.barycentric[0], point.barycentric[1], point.barycentric[2]});
}

}  // namespace ahm::test
