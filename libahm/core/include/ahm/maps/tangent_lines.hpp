/// \file
/// Straight lines and shortest paths over the tangent planes of a graph, for clouds, grids and graphs without faces. On meshes
/// `ExactGeodesics` computes exact lines and paths.
///
/// \code
/// ahm::TangentLine line = ahm::trace_line(graph, {ahm::Vertex{7}}, {1, 0}, 0.5);
/// ahm::TangentLine path = ahm::shortest_line(graph, {ahm::Vertex{7}}, {ahm::Vertex{90}});
/// for (const ahm::TangentPlanePoint& place : path.places) use(*ahm::position(graph, place));
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// A point of the tangent plane of a vertex, near the vertex.
struct TangentPlanePoint {
  Vertex vertex;
  Vec2 offset{};  ///< position relative to the vertex, in its frame, world units
};

/// A line over tangent planes. Its places are the start, the points where it leaves the cell of a vertex, and the end. The cell of a
/// vertex is the part of its tangent plane that is nearer to it than to its neighbors.
struct TangentLine {
  /// ok; `disconnected` if no path connects the ends; the other members are then empty.
  Status status = Status::ok;
  std::vector<TangentPlanePoint> places;
  double length = 0;     ///< sum of the lengths in the tangent planes, world units
  bool complete = true;  ///< `trace_line`: whether the line has the requested length; otherwise it ends at the boundary
  Vec2 departure{};      ///< unit direction at the first place, in the frame of its vertex; zero for a path of length 0
  Vec2 arrival{};        ///< unit direction at the last place, in the frame of its vertex; zero for a path of length 0
};

/// Traces a straight line. It goes from cell to cell; e_ij and R_ji transport its position and direction between the tangent planes of
/// neighbors. On flat graphs the line is straight up to rounding. On smooth surfaces it converges to the geodesic with an order between
/// one and two in the edge length.
///
/// The line ends at the boundary: where it would leave the last vertex between two neighbors that are more than 120 degrees apart, farther
/// away than both.
/// @param direction  direction in the frame of the vertex, any length > 0
/// @param length     >= 0, world units
/// @throws InvalidArgument (dimension other than 2, vertex, offset, direction, length)
TangentLine trace_line(const TangentGraph& graph, const TangentPlanePoint& from, const Vec2& direction, double length);

/// The shortest path. It follows the distances of a `Wavefront` from one end back to the other. Then it is straightened by shooting, unless
/// an obstacle is in between. The path is computed from both ends and the shorter one returned, so the reversed path is the same curve. On
/// flat graphs it is straight up to rounding. On smooth surfaces its length is of second order. It takes two fronts from end to end.
/// @throws InvalidArgument (dimension other than 2, vertex, offset)
TangentLine shortest_line(const TangentGraph& graph, const TangentPlanePoint& from, const TangentPlanePoint& to);

/// The point of a source in the tangent plane of its vertex of largest weight.
/// @throws InvalidArgument (a curve, another dimension than 2)
TangentPlanePoint tangent_plane_point(const Source& source);
/// The u axis of a source at its vertex of largest weight: unit length, frame of the vertex.
/// @throws InvalidArgument (a curve, another dimension than 2)
Vec2 u_axis_at_point(const Source& source);

/// Position of a place in space, world units; nullopt for graphs without frames.
std::optional<Vec3> position(const TangentGraph& graph, const TangentPlanePoint& place);
/// Mean of the positions of a place in its tangent plane and those of the neighbors; nearer vertices have larger weights. On noisy clouds,
/// where the planes of neighbors do not meet, this avoids jumps of a line between them. nullopt for graphs without frames.
std::optional<Vec3> smooth_position(const TangentGraph& graph, const TangentPlanePoint& place);

}  // namespace ahm
