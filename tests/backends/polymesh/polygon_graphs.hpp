/// \file
/// Graphs of generated polygon meshes, and their maps beside the plane.
#pragma once

#include <cmath>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"

namespace ahm::test {

/// The polygons as they are, without refinement.
inline polymesh::PolygonMeshSurface build(const Polygons& mesh, polymesh::PolygonOptions options = {}) {
  options.discretization = polymesh::Discretization::polygons;
  return polymesh::PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, options);
}

/// Largest distance between the map and the plane seen from `origin` with unit axis `axis`; infinite unless all is
/// mapped but, where that is `allowed`, vertices whose heat has lost its sign.
inline double plane_error(const Polygons& mesh, const RowLogMap& map, const Vec2& origin, const Vec2& axis,
                          bool allowed = false) {
  std::vector<Vec2> plane;
  std::vector<double> u, v;
  for (std::size_t i = 0; i < mesh.plane.size(); ++i) {
    if (allowed && map.status[i] == Status::unreached) continue;
    plane.push_back(mesh.plane[i]);
    u.push_back(map.u[i]);
    v.push_back(map.v[i]);
  }
  return plane_error(plane, u, v, origin, axis);
}

}  // namespace ahm::test
