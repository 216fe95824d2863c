/// \file
/// Flat meshes in the xy plane, and what a log map on them should be.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "baselines/baselines.hpp"
#include "trimesh/meshes.hpp"

namespace ahm::test {

/// A unit square of side x side points with random diagonals; points move by up to `jitter` spacings inside, but those of
/// the middle row only along it. `side` is odd.
Mesh flat_square(Index side, double jitter = 0.24, unsigned seed = 1);
/// A hexagon of equilateral triangles with `rings` rings of unit edges about its middle vertex, number 0.
Mesh hexagon(Index rings);

/// Vertex nearest to a point of the plane.
Index nearest(const Mesh& mesh, double x, double y);

/// Exact log map of a flat mesh from a vertex, in its frame.
std::array<double, 2> exact_log(const Mesh& mesh, const TangentGraph& graph, Index source, Index vertex);

/// Distance of a vertex from the sides of the unit square.
inline double from_border(const Mesh& mesh, Index i) {
  const auto& p = mesh.plane[i];
  return std::min({p[0], p[1], 1 - p[0], 1 - p[1]});
}

/// Distance in the plane.
inline double plane_distance(const Mesh& mesh, Index i, Index j) {
  const auto &p = mesh.plane[i], &q = mesh.plane[j];
  return std::hypot(p[0] - q[0], p[1] - q[1]);
}

/// Angle between a method's direction and the exact one, radians.
double angle_error(const Mesh& mesh, const TangentGraph& graph, const baselines::Result& result, Index source,
                   Index vertex);

}  // namespace ahm::test
