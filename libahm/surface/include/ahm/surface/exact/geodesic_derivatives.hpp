/// \file
/// The exponential map, distances and log maps with their derivatives, for optimization over points of a mesh.
///
/// The faces along a geodesic unfold into a plane, where the geodesic is a straight line. The derivatives are those of this
/// line, and exact on the flat triangles. They jump where the geodesic begins to pass a vertex on its other side, and at the cut
/// locus.
///
/// \code
/// const ahm::ExponentialPoint end = ahm::exponential_point(geodesics, ahm::Row{42}, {0.1, 0, 0});
/// // Moving the start by a small tangent vector w moves the end by end.by_start * w.
/// \endcode
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

/// A linear map of vectors in space, row by row. Here it maps the tangent plane of one point to that of another, and normals to
/// zero. The tangent plane of a point in a face or on an edge is that of its face. At a vertex it is that of the vertex' frame.
using TangentMap = std::array<double, 9>;

/// The end of a straightest geodesic.
struct ExponentialPoint {
  Vec3 position{};       ///< world units
  bool complete = true;  ///< false: the geodesic ended at the boundary before its full length
  /// Derivatives of the position. At a vertex, where the end jumps with the start, `by_start` is the parallel transport. Both
  /// are zero where the geodesic ended at a vertex of the boundary.
  TangentMap by_start{}, by_vector{};
};

/// The end of the straightest geodesic from a point along a vector: the exponential map.
/// @param vector  world units; projected to the tangent plane, and then as long as the geodesic
/// @throws InvalidArgument (fault "not_orientable"; no positions; a vector that is not finite; as `ExactGeodesics::point`,
/// `exact::trace`)
ExponentialPoint exponential_point(const ExactGeodesics& geodesics, const SurfacePoint& start, const Vec3& vector);

/// A shortest path at its ends. The log map of the source takes the target to the distance times the departure.
struct GeodesicEnds {
  Status status = Status::ok;   ///< the other members are zero where it is not ok
  double distance = 0;          ///< world units
  Vec3 departure{}, arrival{};  ///< unit vectors along the path at the source and at the target; zero at the distance 0
  TangentMap log_by_source{};   ///< derivative of the log map; at a vertex, where it jumps, minus the identity
  TangentMap log_by_target{};   ///< derivative of the log map
};

/// Shortest paths between many pairs of points, as `ExactGeodesics::paths`. The derivative of the distance is the arrival by the
/// target, and minus the departure by the source. At the cut locus, where there are several shortest paths, these are the
/// derivatives along one of them.
/// @param pairs    source and target
/// @param threads  0: one per core; the result does not depend on it
/// @throws InvalidArgument (fault "not_orientable"; no positions; as `ExactGeodesics::point`), Cancelled
std::vector<GeodesicEnds> geodesic_ends(const ExactGeodesics& geodesics,
                                        std::span<const std::array<SurfacePoint, 2>> pairs,
                                        const Progress& progress = {}, unsigned threads = 0);

}  // namespace ahm
