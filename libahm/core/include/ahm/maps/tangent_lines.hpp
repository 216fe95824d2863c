/// \file
/// Straight lines and shortest paths over the tangent planes of a graph: on clouds, grids and graphs, where no faces agree on
/// one surface. On meshes `ExactGeodesics` has the exact ones.
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

/// A point of the tangent plane of a vertex, near it.
struct TangentPlanePoint {
  Vertex vertex;
  Vec2 offset{};  ///< from the vertex, in its frame, world units
};

/// A line from plane to plane. Each place but the last lies where the line leaves the cell of its vertex: the part of the plane
/// that is nearer to it than to its neighbours.
struct TangentLine {
  /// ok; `disconnected` where no path joins the ends, and nothing else is given.
  Status status = Status::ok;
  std::vector<TangentPlanePoint> places;
  double length = 0;     ///< world units, as of the pieces in their planes
  bool complete = true;  ///< of a trace: whether it got as far as was asked for; else it ends at the boundary
  Vec2 departure{};      ///< unit direction at the first place, in the frame of its vertex; zero where the length is
  Vec2 arrival{};        ///< at the last
};

/// The straightest line: from cell to cell, its place and direction carried over by e_ij and R_ji, which unfold the planes of
/// neighbours. Straight on flat graphs, to rounding; on smooth surfaces it comes to the geodesic between first and second order
/// in the edge length. It ends at the boundary beside the last vertex: where it would go on between neighbours more than 120
/// degrees apart, farther away than they are.
/// @param direction  in the frame of the vertex, of any length > 0
/// @param length     >= 0, world units
/// @throws InvalidArgument (dimension other than 2, vertex, offset, direction, length)
TangentLine trace_line(const TangentGraph& graph, const TangentPlanePoint& from, const Vec2& direction, double length);

/// The shortest path: back along the distances of an `Wavefront`, then pulled straight by shooting as long as nothing is in
/// the way; from either end, and the shorter of the two, so that reversed it is the same curve. Straight on flat graphs, to
/// rounding; on smooth surfaces of second order in length. Takes as long as the front takes from end to end, twice.
/// @throws InvalidArgument (dimension other than 2, vertex, offset)
TangentLine shortest_line(const TangentGraph& graph, const TangentPlanePoint& from, const TangentPlanePoint& to);

/// Where a source lies, seen from its vertex of the largest weight, and its u axis there (unit; frame of the vertex).
/// @throws InvalidArgument (a curve, another dimension than 2)
TangentPlanePoint tangent_plane_point(const Source& source);
Vec2 u_axis_at_point(const Source& source);

/// Where a place lies in space, world units; none for graphs without frames.
std::optional<Vec3> position(const TangentGraph& graph, const TangentPlanePoint& place);
/// The same as the planes around have it too, weighted by how near their vertices are: where planes of neighbours do not meet, as
/// on noisy clouds, a line does not jump from one to the other.
std::optional<Vec3> smooth_position(const TangentGraph& graph, const TangentPlanePoint& place);

}  // namespace ahm
