/// \file
/// Straight lines traced over a polyhedral surface.
#pragma once

#include <vector>

#include "exact/propagation.hpp"

namespace ahm::exact {

/// A straight line that is traced from face to face.
struct Line {
  Half half = -1;            ///< half-edge in whose frame the line is
  Place start{};             ///< start of the line, unfolded into this frame
  Place direction{};         ///< unit vector
  double walked_length = 0;  ///< length traced so far

  Place at(double s) const { return start + s * direction; }
};

/// The point where a line leaves a face.
struct Exit {
  double walked_length;  ///< length along the line
  Half side;             ///< half-edge of the same face, through which the line leaves
  double along;          ///< distance from the tail of that half-edge
};

/// The line in the frame of another half-edge of the same face.
Line in_frame_of(const PolyhedralSurface& surface, Line line, Half half);

/// The exit of a line through a given side, or through the nearer end of that side.
Exit leave_through(const PolyhedralSurface& surface, const Line& line, Half side);
/// The exit of a line that entered the face through its half-edge, or that starts on or below it.
Exit leave_upwards(const PolyhedralSurface& surface, const Line& line);
/// The exit of a line that starts inside its face.
Exit leave(const PolyhedralSurface& surface, const Line& line);

/// The line in the face across a side; half < 0 on the boundary.
Line cross_side(const PolyhedralSurface& surface, const Line& line, const Exit& exit);

/// The surface point at a place in the frame of a half-edge, and the surface point on a half-edge.
MeshPoint point_of(const PolyhedralSurface& surface, Half half, const Place& place);
MeshPoint point_on(const PolyhedralSurface& surface, Half side, double along);

/// The line from a vertex, at an unscaled angle from the right side of the vertex's first corner.
Line line_from_vertex(const PolyhedralSurface& surface, Index vertex, double angle);
/// The line from a place in the face of a half-edge, at an angle in the half-edge's frame.
Line line_from(Half half, const Place& place, double angle);

/// The angle of a line in the frame of side 0 of its face.
double angle_in_face(const PolyhedralSurface& surface, const Line& line);

/// The unscaled angle of the direction from a vertex to a place in one of its faces, from the right side of its first corner.
/// @param corner   half-edge of the face that starts at the vertex; `towards` is in its frame
struct VertexAngle {
  double angle;
  bool forward;  ///< whether the corner's face has the orientation of the vertex
};
VertexAngle angle_at_vertex(const PolyhedralSurface& surface, Half corner, const Place& towards);

}  // namespace ahm::exact
