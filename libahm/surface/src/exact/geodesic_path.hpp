/// \file
/// Going straight on over a polyhedral surface.
#pragma once

#include <vector>

#include "exact/propagation.hpp"

namespace ahm::exact {

/// A straight line that is being followed from face to face.
struct Line {
  Half half = -1;     ///< in whose frame it is given
  Place start{};      ///< where it started, unfolded
  Place direction{};  ///< unit vector
  double walked = 0;  ///< how far it has been followed

  Place at(double s) const { return start + s * direction; }
};

/// Where a line leaves a face.
struct Exit {
  double walked;  ///< along the line
  Half side;      ///< half-edge of the same face
  double along;   ///< from the tail of that half-edge
};

/// The same line in the frame of another half-edge of its face.
Line in_frame_of(const PolyhedralSurface& surface, Line line, Half half);

/// Leaves the face of a line through a given side, or its nearer end.
Exit leave_through(const PolyhedralSurface& surface, const Line& line, Half side);
/// Leaves the face of a line that entered it through its half-edge, or starts on it or below.
Exit leave_upwards(const PolyhedralSurface& surface, const Line& line);
/// Leaves the face of a line that starts inside it.
Exit leave(const PolyhedralSurface& surface, const Line& line);

/// The line in the face beyond a side; half < 0 where there is none.
Line cross_side(const PolyhedralSurface& surface, const Line& line, const Exit& exit);

/// The point of the face where a place in the frame of a half-edge lies, and the point of a half-edge.
MeshPoint point_of(const PolyhedralSurface& surface, Half half, const Place& place);
MeshPoint point_on(const PolyhedralSurface& surface, Half side, double along);

/// The line from a vertex that leaves it at a true angle from the right side of its first corner.
Line line_from_vertex(const PolyhedralSurface& surface, Index vertex, double angle);
/// The line from a place in the face of a half-edge, at an angle in its frame.
Line line_from(Half half, const Place& place, double angle);

/// The angle of a line in the frame of side 0 of its face.
double angle_in_face(const PolyhedralSurface& surface, const Line& line);

/// The true angle, from the right side of the first corner, at which a vertex sees a place in one of its faces.
/// @param corner   the half-edge of the face that starts at the vertex; the place is in its frame
double angle_at_vertex(const PolyhedralSurface& surface, Half corner, const Place& towards);

}  // namespace ahm::exact
