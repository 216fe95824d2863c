/// \file
/// Walks from face to face, unfolded into the plane, and the shortest lines within them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/exact/geodesic_path.hpp"
#include "exact/propagation.hpp"

namespace ahm::exact {

/// The half-edge beyond a side, negative on the boundary, and whether the face there is oppositely oriented.
inline Half beyond(const PolyhedralSurface& surface, Half side) { return surface.record(next(side)).beyond_left; }
inline bool mirrored_beyond(const PolyhedralSurface& surface, Half side) {
  return (surface.record(next(side)).mirrored & 1) != 0;
}
/// From the frame of a half-edge to that of side 0 of its face, and back.
Place to_first_side(const PolyhedralSurface& surface, Half half, const Place& p);
Place from_first_side(const PolyhedralSurface& surface, Half half, const Place& p);

/// An end of a curve: a point of a face, or the vertex at a corner.
struct CurveEnd {
  MeshPoint point;
  Half corner = -1;  ///< starts at the vertex; -1: no vertex
};

/// Faces that neighbour each other, from one end of a curve to the other.
struct Strip {
  CurveEnd start, end;        ///< the points of the first and of the last face
  std::vector<Half> entered;  ///< by which the further faces are entered, in their order

  Index last_face() const { return entered.empty() ? start.point.face : entered.back() / 3; }
};

/// Adds a step to a walk; a step straight back undoes the one before.
void enter(const PolyhedralSurface& surface, std::vector<Half>& entered, Half half);
/// Leaves faces out at either end where the vertex of the end is one of the next face, too.
void trim(const PolyhedralSurface& surface, Strip& strip);

/// The half-edges that enter the faces one meets when turning about a vertex from a corner to another one; none where the
/// boundary lies between.
std::optional<std::vector<Half>> turn(const PolyhedralSurface& surface, Half from, Half to, bool left);

/// The strip along a curve. Neighbouring points lie in one face; they may be vertices or lie on sides.
/// @throws InvalidArgument (a point outside its face, neighbours without a common face)
Strip strip_along(const PolyhedralSurface& surface, std::span<const MeshPoint> curve);

/// A side that the strip crosses, unfolded into the frame of side 0 of the first face.
struct Portal {
  Place left, right;
  bool tail_left;  ///< whether the tail of the half-edge entered is on the left
};

/// A point of the shortest line: its start, a vertex where it bends, its end.
struct Bend {
  Place at;
  bool left = false;                    ///< on which side of the strip the vertex is
  std::size_t arrives = 0, leaves = 0;  ///< portals: the first and the last that the line crosses at this vertex
};

/// The shortest line in a strip.
struct TautLine {
  std::vector<Portal> portals;
  std::vector<Bend> bends;  ///< start and end included
  double length = 0;
  Vec2 arrival{};  ///< the last bend before the end, in the frame of side 0 of the last face

  /// Where the line crosses each portal, as a share of it from the left.
  std::vector<double> crossings() const;
};

/// The shortest line in a strip by Lee and Preparata's funnel [LP84]. Linear in its faces.
TautLine pull_taut(const PolyhedralSurface& surface, const Strip& strip);

/// Angles at a vertex below pi by less than this are pi.
inline constexpr double straight_margin = 1e-9;

/// Moves the strip to the other side of vertices until the taut line in it is locally shortest.
/// @return that line
TautLine shorten(const PolyhedralSurface& surface, Strip& strip);

/// Takes the strip of a locally shortest line past vertices to their other side where the line is shorter there, until
/// there is none: a line that passes an interior vertex has a second one of its kind beyond it where both sides see its
/// ends at less than pi.
/// @return the line; as short as the one given at least
TautLine pass_other_side(const PolyhedralSurface& surface, Strip& strip, TautLine line);

/// The half-edges that lead around the other side of a bend; none where the boundary is there.
std::optional<std::vector<Half>> other_side(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line,
                                            const Bend& bend);

/// The half-edge whose face was entered last at a bend, as the corner of that face at the vertex.
Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal);

/// The line as points of the surface.
GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line);

}  // namespace ahm::exact
