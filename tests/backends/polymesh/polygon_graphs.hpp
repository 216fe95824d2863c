/// \file
/// Surfaces of generated polygon meshes.
#pragma once

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "backends/surface_maps.hpp"

namespace ahm::test {

using polymesh::Discretization;
using polymesh::PolygonMeshSurface;
using polymesh::PolygonOptions;

inline PolygonMeshSurface build(const Polygons& mesh, Discretization discretization) {
  return PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, {.discretization = discretization});
}

/// The polygons as they are, without refinement.
inline PolygonMeshSurface build(const Polygons& mesh, PolygonOptions options = {}) {
  options.discretization = Discretization::polygons;
  return PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, options);
}

inline polymesh::Refinement refined(const Polygons& mesh) {
  return polymesh::PolygonMesh::from_faces(mesh.positions, mesh.begin, mesh.corners).refined();
}

}  // namespace ahm::test
