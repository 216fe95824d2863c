/// \file
/// Surfaces of generated parts.
#pragma once

#include "ahm/conformance/parts.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {

/// Two boxes that do not touch.
inline Mesh two_boxes() { return joined(box({4, 3, 1}), box({1, 1, 1}), {6, 1, 0}); }

inline trimesh::TriangleMeshSurface surface_of(const Mesh& mesh) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

}  // namespace ahm::test
