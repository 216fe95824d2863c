/// \file
/// Straight lines and shortest paths over the tangent planes of a surface, from and to points of the input, in space: of clouds
/// above all. Meshes have exact ones (`ExactGeodesics`).
///
/// \code
/// ahm::SurfacePath path = ahm::shortest_line(cloud, ahm::Row{3}, ahm::Row{42});
/// ahm::SurfacePath line = ahm::trace_line(cloud, ahm::Row{3}, {0, 0, 1}, 0.5);
/// \endcode
#pragma once

#include <vector>

#include "ahm/surface/surface.hpp"

namespace ahm {

struct SurfacePath {
  Status status = Status::ok;  ///< `disconnected`: there is no path
  /// World units. The ends lie in the planes of their points; between them planes of neighbours are blended
  /// (`smooth_position`).
  std::vector<Vec3> points;
  /// World units; no less than from end to end in space, which on noisy clouds the planes' own may be.
  double length = 0;
  bool complete = true;  ///< of a trace; else it ended at the boundary
};

/// `shortest_line` between points of the surface.
/// @throws InvalidArgument (as `Surface::source`; a graph without frames)
SurfacePath shortest_line(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to);

/// `trace_line` from a point along a vector of space, projected to the surface.
/// @param length  >= 0, world units
/// @throws InvalidArgument (as `Surface::source`, `trace_line`; a graph without frames)
SurfacePath trace_line(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double length);

}  // namespace ahm
