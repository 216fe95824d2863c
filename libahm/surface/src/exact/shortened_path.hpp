/// \file
/// Strips of faces, unfolded into the plane, and the shortest lines in them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/exact/geodesic_path.hpp"
#include "exact/propagation.hpp"

namespace ahm::exact {

/// The half-edge across a side (negative on the boundary), and whether the face there has the opposite orientation.
inline Half beyond(const PolyhedralSurface& surface, Half side) { return surface.record(next(side)).beyond_left; }
inline bool mirrored_beyond(const PolyhedralSurface& surface, Half side) {
  return (surface.record(next(side)).mirrored & 1) != 0;
}
/// Converts a place from the frame of a half-edge to that of side 0 of its face, and back.
Place to_first_side(const PolyhedralSurface& surface, Half half, const Place& p);
Place from_first_side(const PolyhedralSurface& surface, Half half, const Place& p);

/// An end of a curve: a point of a face, or the vertex at a corner.
struct CurveEnd {
  MeshPoint point;
  Half corner = -1;  ///< half-edge that starts at the vertex; -1: no vertex
};

/// A sequence of adjacent faces, from one end of a curve to the other.
struct Strip {
  CurveEnd start, end;        ///< points of the first and of the last face
  std::vector<Half> entered;  ///< half-edges through which the faces after the first are entered, in order

  Index last_face() const { return entered.empty() ? start.point.face : entered.back() / 3; }
};

/// Adds a step to a walk over faces. A step back through the same side removes the step before.
void enter(const PolyhedralSurface& surface, std::vector<Half>& entered, Half half);
/// Removes faces at either end where the vertex of the end also belongs to the next face.
void trim(const PolyhedralSurface& surface, Strip& strip);

/// The half-edges that enter the faces around a vertex, turning from one corner to another; none where the boundary lies
/// between.
std::optional<std::vector<Half>> turn(const PolyhedralSurface& surface, Half from, Half to, bool left);

/// The strip along a curve. Consecutive points lie in one face; they may be vertices or lie on sides.
/// @throws InvalidArgument (a point outside its face, consecutive points without a common face)
Strip strip_along(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// A side that the strip crosses, unfolded into the frame of side 0 of the first face.
struct Portal {
  Place left, right;
  bool tail_left;  ///< whether the tail of the entered half-edge is on the left
};

/// A point of the shortest line: its start, a vertex where it bends, or its end.
struct Bend {
  Place at;
  bool left = false;                    ///< side of the strip on which the vertex lies
  std::size_t arrives = 0, leaves = 0;  ///< first and last portal that the line crosses at this vertex
};

/// The shortest line in a strip.
struct TautLine {
  std::vector<Portal> portals;
  std::vector<Bend> bends;  ///< including start and end
  double length = 0;
  Vec2 arrival{};  ///< position of the last bend before the end, in the frame of side 0 of the last face

  /// Where the line crosses each portal, as a fraction of the portal from the left.
  std::vector<double> crossings() const;
};

/// The shortest line in a strip, by the funnel algorithm of Lee and Preparata [LP84]. Linear in the number of faces.
TautLine pull_taut(const PolyhedralSurface& surface, const Strip& strip);

/// Angles at a vertex that are below pi by less than this are treated as pi.
inline constexpr double straight_margin = 1e-9;

/// Moves the strip to the other side of vertices until its shortest line is locally shortest on the surface.
/// @return that line
TautLine shorten(const PolyhedralSurface& surface, Strip& strip);

/// Moves a locally shortest line to the other side of vertices where it is shorter there, until there is no such vertex. Where
/// the ends of a line are at less than pi on both sides of an interior vertex, another locally shortest line passes on its other
/// side.
/// @return the line; at most as long as `line`
TautLine pass_other_side(const PolyhedralSurface& surface, Strip& strip, TautLine line);

/// The half-edges through which a strip passes a bend on its other side; none where the boundary is there.
std::optional<std::vector<Half>> other_side(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line,
                                            const Bend& bend);

/// The corner at the vertex of a bend, in the face that is entered through a portal.
Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal);

/// Converts a line to points of the surface.
GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line);

}  // namespace ahm::exact
