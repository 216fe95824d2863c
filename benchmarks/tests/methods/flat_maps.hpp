/// \file
/// Exact log maps and errors on a flat mesh in the xy plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"
#include "methods/method.hpp"

namespace ahm::test {

/// Exact log map of a flat mesh from a vertex, in the frame of that vertex.
inline Vec2 exact_log(const Mesh& mesh, const TangentGraph& graph, Index source, Index vertex) {
  const Frame frame = *graph.frame(source);
  const Vec3 offset = minus(mesh.positions[vertex], mesh.positions[source]);
  return {dot(frame.x, offset), dot(frame.y, offset)};
}

/// Distance of a vertex from the sides of the unit square.
inline double border_distance(const Mesh& mesh, Index i) {
  const auto& p = mesh.plane[i];
  return std::min({p[0], p[1], 1 - p[0], 1 - p[1]});
}

/// Distance of two vertices in the plane.
inline double plane_distance(const Mesh& mesh, Index i, Index j) {
  const auto &p = mesh.plane[i], &q = mesh.plane[j];
  return std::hypot(p[0] - q[0], p[1] - q[1]);
}

/// Angle between the directions of a method and of the exact map, radians.
inline double angle_error(const Mesh& mesh, const TangentGraph& graph, const methods::Result& result, Index source,
                          Index vertex) {
  const auto exact = exact_log(mesh, graph, source, vertex);
  const double u = result.coordinates[2 * vertex], v = result.coordinates[2 * vertex + 1];
  return std::abs(std::atan2(v * exact[0] - u * exact[1], u * exact[0] + v * exact[1]));
}

}  // namespace ahm::test
