/// \file
/// Meshes of quads.
///
/// \code
/// const Quads quads = quads_of(torus(10000));      // the same vertices; quad f is faces 2 f and 2 f + 1 of the mesh
/// auto surface = ahm::polymesh::PolygonMeshSurface::build(quads.points, quads.begin, quads.corners);
/// \endcode
#pragma once

#include "shapes.hpp"

namespace ahm::bench {

struct Quads {
  std::vector<Vec3> points;
  std::vector<Offset> begin{0};  ///< faces + 1 offsets into `corners`
  std::vector<Index> corners;
};

/// Joins faces 2 f and 2 f + 1 of a mesh, which `torus` makes as the halves of a quad.
inline Quads quads_of(const Mesh& mesh) {
  Quads quads{mesh.positions};
  for (std::size_t f = 0; f + 1 < mesh.faces.size(); f += 2) {
    const auto &a = mesh.faces[f], &b = mesh.faces[f + 1];
    if (a[2] == b[1])  // cut from corner 0 to corner 2, otherwise from 1 to 3
      quads.corners.insert(quads.corners.end(), {a[0], a[1], a[2], b[2]});
    else
      quads.corners.insert(quads.corners.end(), {a[0], a[1], b[1], a[2]});
    quads.begin.push_back(static_cast<Offset>(quads.corners.size()));
  }
  return quads;
}

}  // namespace ahm::bench
