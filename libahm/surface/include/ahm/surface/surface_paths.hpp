/// \file
/// Straight lines and shortest paths in space, over the tangent planes of a surface, between points of the input. Mainly
/// for clouds; meshes have exact paths (`ExactGeodesics`).
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
  /// Points of the path, world units. The ends lie in the planes of their points; between them, the planes of neighbors are
  /// blended (`smooth_position`).
  std::vector<Vec3> points;
  /// Length, world units. At least the straight-line distance between the ends, which can exceed the length over the planes on
  /// noisy clouds.
  double length = 0;
  bool complete = true;  ///< for traces: false where the trace ended at the boundary
};

/// `shortest_line` between points of the surface.
/// @throws InvalidArgument (as `Surface::source`; a graph without frames)
SurfacePath shortest_line(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to);

/// `trace_line` from a point along a vector of space that is projected to the surface.
/// @param length  >= 0, world units
/// @throws InvalidArgument (as `Surface::source`, `trace_line`; a graph without frames)
SurfacePath trace_line(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double length);

}  // namespace ahm
