/// \file
/// Locally shortest curves: fast on surfaces of any size, not always the shortest of all.
///
/// \code
/// ahm::exact::GeodesicPath path = ahm::exact::locally_shortest_path(surface, from, to);
/// ahm::exact::GeodesicPath loop = ahm::exact::shortened_loop(surface, around.points);   // a closed geodesic
/// \endcode
#pragma once

#include <functional>
#include <span>

#include "ahm/surface/exact/geodesic_path.hpp"

namespace ahm::exact {

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
