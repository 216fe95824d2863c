/// \file
/// Geodesics as curves: shortest paths to where an exact map reaches, and straightest geodesics from a point.
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

/// A shortest path. Between neighbouring points it is straight inside one face.
struct GeodesicPath {
  Status status = Status::ok;  ///< of the point it leads to; without points where not ok
  /// From the source: where the path starts, crosses a side, bends at or passes a vertex, and ends.
  std::vector<MeshPoint> points;
  double length = 0;  ///< world units
  /// The directions in which it leaves its two ends, so that a path turned round has them swapped; as
  /// `ExactMap::direction`, about the end as about the start.
  double start_direction = 0, end_direction = 0;
  Index source = -1;  ///< number of the source it comes from
};

/// The path that an exact map found, by unfolding the faces between the points where it bends. Linear in its points.
/// @param surface  the map's own
/// @throws InvalidArgument (vertex or target out of range, a map with a tolerance)
GeodesicPath path_to_vertex(const PolyhedralSurface& surface, const ExactMap& map, Vertex vertex);
GeodesicPath path_to_target(const PolyhedralSurface& surface, const ExactMap& map, std::size_t target);

/// A shortest path between two points; of several of one length the same one each time. The propagation ends where it
/// has reached the farther point.
/// @throws as `exact_map`
GeodesicPath geodesic_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to);

/// The shortest path through these points in this order, which bends at them; `closed`: and back to the first.
/// @return the status of the first stop that cannot be reached, without points, where there is one
/// @throws InvalidArgument (fewer than two points), as `exact_map`
GeodesicPath geodesic_path(const PolyhedralSurface& surface, std::span<const MeshPoint> stops, bool closed = false);

/// Start and end of a path.
using PointPair = std::array<MeshPoint, 2>;

/// Shortest paths between many pairs of points, each as `geodesic_path` finds it: one propagation for every distinct start,
/// which ends where all its ends are reached, on several threads.
/// @param threads  0: one per core; the result does not depend on it
/// @return one per pair; a status that is not ok, and no points, where the surface does not connect it
/// @throws as `exact_map`
std::vector<GeodesicPath> geodesic_paths(const PolyhedralSurface& surface, std::span<const PointPair> pairs,
                                         const Progress& progress = {}, unsigned threads = 0);

/// How a straightest geodesic ended.
enum class TraceEnd {
  complete,  ///< at its full length
  boundary,  ///< at the boundary, before that
};

/// A straightest geodesic [PS98].
struct TracedPath {
  TraceEnd end = TraceEnd::complete;
  std::vector<MeshPoint> points;  ///< as `GeodesicPath::points`
  double length = 0;              ///< as far as it came
  /// The direction it would go on in, from side 0 of the face of its last point.
  double direction = 0;
};

/// The straightest geodesic from a point: straight through faces, through vertices with equal angles on both sides, and on
/// where it runs along the boundary or, at one of its vertices, pi lies on one side. The
/// exponential map: where a path leaves a point in this direction, with no vertex on its way, the trace follows it.
/// @param direction  as `ExactMap::direction`: at a vertex scaled by `angle_scale`, elsewhere from side 0 of the face
/// @param length     world units, >= 0
/// @throws InvalidArgument (a point outside its face, direction or length; fault line_too_long: more than a million sides are
/// crossed)
TracedPath trace(const PolyhedralSurface& surface, const MeshPoint& from, double direction, double length);

/// A curve pulled taut between its ends: over the faces that it runs through it is as short as can be, and wherever it
/// bends at a vertex, both sides have an angle of at least pi (to 1e-9) or the boundary, so that no curve nearby is
/// shorter [XW07]. Never longer than the curve.
/// @param curve  at least 2 points; neighbouring ones lie in one face. They may be vertices or lie on sides
/// @throws InvalidArgument (fewer than 2 points, a point outside its face, neighbours without a common face)
GeodesicPath shortened_path(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// A closed curve pulled taut: locally shortest everywhere. It begins and ends at the same point, a vertex where it
/// passes one. A curve that goes around nothing shrinks to a point, of length 0.
/// @param curve  at least 3 points, as above; the last one is joined to the first, or is the same
/// @throws InvalidArgument as above
GeodesicPath shortened_loop(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// A locally shortest path between two points: the shortest along the edges and straight across them, pulled taut, and
/// moved to the other side of single vertices where it is shorter there. In time near linear in the number of vertices
/// nearer than `to` along the edges.
/// @param at_least  no more than the distance of a vertex from `to`: of several such functions the largest searches
///                  least; empty: none
/// @return a status that is not ok, and no points, where the surface does not connect them
/// @throws InvalidArgument (a point outside its face)
GeodesicPath locally_shortest_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to,
                                   const std::function<double(Vertex)>& at_least = {});

}  // namespace ahm::exact
