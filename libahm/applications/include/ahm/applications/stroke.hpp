/// \file
/// Curves as sources: stroke-aligned parameterization (Sec. 5, Fig. 19). Every vertex gets the coordinates of the curve
/// point nearest to it, moved on by the way from there, in the curve's own frame.
///
/// \code
/// std::vector path{ahm::Vertex{4}, ahm::Vertex{5}, ahm::Vertex{6}};         // neighbours in the graph
/// auto map = solver.solve(ahm::stroke_source(graph, path));              // u: arclength, v: signed distance (left > 0)
/// auto ring = solver.solve(ahm::stroke_source(graph, loop, {.closed = true, .shape = ahm::StrokeShape::circle}));
/// // points in faces, at vertices, ..., whose u axes run along the curve, and the way from each to the next
/// auto drawn = solver.solve(ahm::stroke_source(sources, lengths));
/// \endcode
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

/// Where a curve goes in the plane of coordinates.
enum class StrokeShape {
  line,    ///< (arclength, 0); on a closed curve u jumps by the length at the first vertex
  circle,  ///< a counter-clockwise circle about the origin that has the curve's length, from its u axis; closed only
};

struct StrokeOptions {
  bool closed = false;  ///< the last vertex is joined to the first
  StrokeShape shape = StrokeShape::line;
};

/// The source along a path of neighbouring vertices, d = 2: weight, half of the two edges at a vertex; u axis, turned
/// with the curve; v, left of it as seen in the frame of the first vertex.
/// @param path  vertex numbers, at least 2, closed: 3
/// @throws InvalidArgument (d, length, index, vertices that are no neighbours, a path that turns back or closes along a
/// one-sided band, `circle` on an open path)
Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, const StrokeOptions& options = {});

/// The same with the user's own parameterization.
/// @param positions  one (u, v) per vertex of the path, world units; consecutive ones differ
Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, std::span<const Vec2> positions,
                     bool closed = false);

/// A point of a polyline on the surface, wherever the backend can put a source: in a face, on an edge, at a vertex.
struct StrokePoint {
  Source point;   ///< its u axis along the curve; of dimension 2
  double weight;  ///< > 0, about half of the lengths of the two adjacent segments
  Vec2 position;  ///< coordinates of the point, world units
  double angle;   ///< direction of the curve in the plane of coordinates, radians
};

/// One source from the points of a polyline. Its spacing should not exceed the edge length by much.
/// @throws InvalidArgument (no points, a source that is not of dimension 2)
Source stroke_source(std::span<const StrokePoint> points);

/// The points of a polyline by arclength: weights, positions and angles follow from the lengths of the segments.
/// @param points   at least 2, closed: 3; sources whose u axis runs along the curve and whose v axis is left of it
/// @param lengths  > 0: lengths[k] from point k to the next one, world units; one fewer than points, closed: as many
/// @throws InvalidArgument (counts, a length, a source that is not of dimension 2, `circle` on an open curve)
std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       const StrokeOptions& options = {});
/// The same with the user's own parameterization.
/// @param positions  one (u, v) per point, world units; consecutive ones differ
std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       std::span<const Vec2> positions, bool closed = false);

/// One source from either.
Source stroke_source(std::span<const Source> points, std::span<const double> lengths,
                     const StrokeOptions& options = {});
Source stroke_source(std::span<const Source> points, std::span<const double> lengths, std::span<const Vec2> positions,
                     bool closed = false);

/// A point on a surface, or one in space: the point of the surface nearest to it.
using CurvePoint = std::variant<Vec3, SurfacePoint>;

/// A curve on a surface and what it amounts to.
struct SurfaceCurve {
  Source source{2};                  ///< for heat
  std::vector<ExactSource> samples;  ///< the same for `ExactGeodesics::log_map`: the middles of the pieces
  std::vector<double> pieces;        ///< their lengths, world units
  std::vector<Vec3> points;    ///< corners of the lines, on the surface, world units; of closed ones without the last
  std::optional<Frame> first;  ///< u along the curve, v left of it, in its first piece
  double length = 0;           ///< world units
  double gap = 0;              ///< largest distance of the polyline in space from the surface
  double jump = 0;             ///< longest piece
  /// How many of the lines between given points are straight in space where they should be shortest paths, and why: the
  /// message of `Surface::flat_triangles`, or that the surface does not connect their ends.
  Index straight = 0;
  std::string straight_reason;
  std::optional<StrokeOptions> shape;  ///< of the coordinates; none: the user's own
};

/// Joins the given points, cuts the lines into pieces of about half of the edges there, and takes the points of the surface nearest
/// to their middles (`Surface::closest_point`). The lines are shortest paths between the given points, over flat faces or, on
/// clouds, over tangent planes (`shortest_line`), on clouds between points closer than two edges straight lines; on twisted polygons
/// they are straight in space (`SurfaceCurve::straight`): give points so close that they stay near the surface.
/// @throws InvalidArgument (as `Surface::source`; faults curve_too_long: more than a million pieces, curve_too_short: fewer
/// than 2 different points, closed: 3, curve_turns_back at a given point, curve_one_sided: closed along a one-sided band), as
/// `stroke_source`
SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, const StrokeOptions& options = {});

/// The same with the user's own parameterization.
/// @param positions  one (u, v) per given point, world units; straight in between, along which consecutive ones differ
SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, std::span<const Vec2> positions,
                        bool closed = false);

/// How far a map from a curve must reach for all rows within a radius of the curve, world units: its own distances are those
/// from the middles of pieces.
double map_radius_of_curve(const SurfaceCurve& curve, double radius);

/// The map from a curve by row. Its distances are those from the curve: as the coordinates have it beside the curve and in the
/// plane, within what the map's own, from samples of the curve, leave open (for exact maps; for others half a piece more). The map's own are told where the coordinates are the user's own. Angles, which mean nothing from a curve, are left out.
/// @param radius  rows farther than this are beyond it, world units; the map must reach `map_radius_of_curve`
RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve,
                          double radius = std::numeric_limits<double>::infinity());

}  // namespace ahm
