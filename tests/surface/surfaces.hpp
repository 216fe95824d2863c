/// \file
/// Lattices of quads, and the surfaces built from them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {

/// Whether the last column of a lattice is joined to the first one.
enum class Columns { open, closed };

/// Rows of quads. The vertex in a row and a column has number row * columns + column.
inline Polygons quads(Index rows, Index columns, Columns ends, const std::function<Vec3(Index, Index)>& position) {
  Polygons mesh;
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j) mesh.positions.push_back(position(i, j));
  for (Index i = 0; i + 1 < rows; ++i)
    for (Index j = 0; j + (ends == Columns::closed ? 0 : 1) < columns; ++j) {
      const Index a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.add({a, b, b + columns, a + columns});
    }
  return mesh;
}

/// Cuts each face into triangles at its first corner.
inline Mesh triangles(const Polygons& polygons) {
  Mesh mesh{polygons.positions, {}, {}};
  for (Index f = 0; f < polygons.faces(); ++f) {
    const std::vector<Index> face = polygons.face(f);
    for (std::size_t c = 2; c < face.size(); ++c) mesh.faces.push_back({face[0], face[c - 1], face[c]});
  }
  return mesh;
}

inline Polygons polygons(const Mesh& mesh) {
  Polygons result;
  result.positions = mesh.positions;
  for (const Triangle& t : mesh.faces) result.add({t[0], t[1], t[2]});
  return result;
}

inline trimesh::TriangleMeshSurface surface_of(const Mesh& mesh) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}
inline polymesh::PolygonMeshSurface surface_of(
    const Polygons& mesh, polymesh::Discretization discretization = polymesh::Discretization::automatic) {
  return polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners,
                                             {.discretization = discretization});
}

/// Calls visit(surface) with a triangle mesh and both discretizations of a polygon mesh.
inline void for_each_surface(const Polygons& mesh, const std::function<void(const Surface&)>& visit) {
  visit(surface_of(triangles(mesh)));
  visit(surface_of(mesh, polymesh::Discretization::polygons));
  visit(surface_of(mesh, polymesh::Discretization::refined));
}

/// Coordinates of a vertex.
inline Vec2 vector_at(const LogMap& map, Index v) {
  const std::span<const double> uv = map.coordinates(Vertex(v));
  return {uv[0], uv[1]};
}

/// Identifier of the error that a call throws; "none" without one.
template <class Call>
std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const Error& e) {
    return std::string(e.fault());
  }
  return "none";
}

}  // namespace ahm::test
