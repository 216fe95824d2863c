/// \file
/// Geodesics as curves: shortest paths from an exact map, and straightest geodesics from a point.
///
/// \code
/// ahm::exact::GeodesicPath path = ahm::exact::geodesic_path(surface, from, to);
/// ahm::exact::TracedPath ray = ahm::exact::trace(surface, from, path.start_direction, path.length);   // ends at `to`
/// \endcode
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"

namespace ahm::exact {

/// A shortest path. Between consecutive points it is straight inside one face.
struct GeodesicPath {
  Status status = Status::ok;  ///< status of the end point; no points where it is not ok
  /// Points from the source to the end: the start, crossings of sides, vertices where the path bends or that it passes, the
  /// end.
  std::vector<MeshPoint> points;
  double length = 0;  ///< world units
  /// Directions in which the path leaves its two ends, both as in `ExactMap::direction`. Reversing the path swaps them.
  double start_direction = 0, end_direction = 0;
  Index source = -1;  ///< number of the source that the path comes from
};

/// The shortest path of an exact map, by unfolding the faces between the points where it bends. Linear in the number of its
/// points.
/// @param surface  surface of the map
/// @throws InvalidArgument (vertex or target out of range)
GeodesicPath path_to_vertex(const PolyhedralSurface& surface, const ExactMap& map, Vertex vertex);
GeodesicPath path_to_target(const PolyhedralSurface& surface, const ExactMap& map, std::size_t target);

/// A shortest path between two points. Where several have the same length, the result is always the same one. The propagation
/// ends when it reaches the end point.
/// @throws as `exact_map`
GeodesicPath geodesic_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to);

/// The shortest path through the stops in their order. It may bend at the stops. `closed`: it returns to the first stop.
/// @return  the path; where a stop cannot be reached, the status of the first such stop and no points
/// @throws InvalidArgument (fewer than two points), as `exact_map`
GeodesicPath geodesic_path(const PolyhedralSurface& surface, std::span<const MeshPoint> stops, bool closed = false);

/// Start and end of a path.
using PointPair = std::array<MeshPoint, 2>;

/// Shortest paths between many pairs of points, each as `geodesic_path` computes it. There is one propagation for every
/// distinct start, which ends when it has reached all ends of that start. Propagations run on several threads.
/// @param threads  0: one per core; the result does not depend on it
/// @return one path per pair; where the surface does not connect the pair, a status that is not ok and no points
/// @throws as `exact_map`
std::vector<GeodesicPath> geodesic_paths(const PolyhedralSurface& surface, std::span<const PointPair> pairs,
                                         const Progress& progress = {}, unsigned threads = 0);

/// How a straightest geodesic ended.
enum class TraceEnd {
  complete,  ///< at its full length
  boundary,  ///< at the boundary, before its full length
};

/// A straightest geodesic [PS98].
struct TracedPath {
  TraceEnd end = TraceEnd::complete;
  std::vector<MeshPoint> points;  ///< as in `GeodesicPath::points`
  double length = 0;              ///< length that was traced
  /// Direction of the line at its last point, from side 0 of the face of that point.
  double direction = 0;
};

/// The straightest geodesic from a point: straight through faces, and through vertices with equal angles on both sides. It also
/// continues along the boundary, and at a boundary vertex with an angle of pi on one side. This is the exponential map: the
/// trace follows any path that leaves the point in this direction and passes no vertex.
/// @param direction  as in `ExactMap::direction`: at a vertex scaled by `angle_scale`, elsewhere from side 0 of the face
/// @param length     world units, >= 0
/// @throws InvalidArgument (a point outside its face, direction or length; fault line_too_long: the line crosses more than a
/// million sides)
TracedPath trace(const PolyhedralSurface& surface, const MeshPoint& from, double direction, double length);

/// Pulls a curve taut between its ends. The result is as short as possible over the faces that it runs through. Wherever it
/// bends at a vertex, each side has an angle of at least pi (to 1e-9) or is the boundary. So no nearby curve is shorter [XW07].
/// Never longer than the curve.
/// @param curve  at least 2 points; consecutive ones lie in one face. They may be vertices or lie on sides
/// @throws InvalidArgument (fewer than 2 points, a point outside its face, consecutive points without a common face)
GeodesicPath shortened_path(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// Pulls a closed curve taut: the result is locally shortest everywhere. It begins and ends at the same point, a vertex where
/// it passes one. A curve that goes around nothing shrinks to a point, of length 0.
/// @param curve  at least 2 different points, as for `shortened_path`; the last one is joined to the first, or is the same
/// @throws InvalidArgument (as `shortened_path`)
GeodesicPath shortened_loop(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// A locally shortest path between two points. It is the shortest edge path, which may also run straight across edges, pulled
/// taut. It is moved to the other side of single vertices where it is shorter there. The time is near linear in the number of
/// vertices nearer than `to` along the edges.
/// @param at_least  lower bound on the distance of a vertex from `to`; the largest such bound searches least; empty: none
/// @return where the surface does not connect the points, a status that is not ok and no points
/// @throws InvalidArgument (a point outside its face)
GeodesicPath locally_shortest_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to,
                                   const std::function<double(Vertex)>& at_least = {});

}  // namespace ahm::exact
