/// \file
/// Curves as sources: stroke-aligned parameterization (Sec. 5, Fig. 19). Every vertex gets the coordinates of the nearest
/// point of the curve, plus the log map from there in the frame of the curve.
///
/// \code
/// std::vector path{ahm::Vertex{4}, ahm::Vertex{5}, ahm::Vertex{6}};         // neighbors in the graph
/// auto map = solver.solve(ahm::stroke_source(graph, path));              // u: arclength, v: signed distance (left > 0)
/// auto ring = solver.solve(ahm::stroke_source(graph, loop, {.closed = true, .shape = ahm::StrokeShape::circle}));
/// // sources in faces, at vertices, ..., with u axes along the curve, and the lengths of the segments between them
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

/// Shape of the curve in the plane of coordinates.
enum class StrokeShape {
  line,    ///< (arclength, 0); on a closed curve u jumps by the length at the first vertex
  circle,  ///< counter-clockwise around the origin, with the length of the curve, from the u axis; closed curves only
};

struct StrokeOptions {
  bool closed = false;  ///< joins the last vertex to the first
  StrokeShape shape = StrokeShape::line;
};

/// The source along an edge path, d = 2. The weight of a vertex is half of its two edges. Its u axis turns with the curve.
/// v is positive on the left of the curve, as seen in the frame of the first vertex.
/// @param path  vertex numbers, at least 2, or 3 if closed
/// @throws InvalidArgument (dimension, length, index, consecutive vertices that are not neighbors, a path that turns back
/// or closes along a one-sided band, `circle` on an open path)
Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, const StrokeOptions& options = {});

/// The source along an edge path with user-defined coordinates.
/// @param positions  (u, v) of each vertex of the path, world units; consecutive ones differ
Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, std::span<const Vec2> positions,
                     bool closed = false);

/// A point of a polyline on the surface: in a face, on an edge or at a vertex, as the backend supports it.
struct StrokePoint {
  Source point;   ///< its u axis points along the curve; dimension 2
  double weight;  ///< > 0, about half of the lengths of the two adjacent segments
  Vec2 position;  ///< (u, v) of the point, world units
  double angle;   ///< direction of the curve in the plane of coordinates, radians
};

/// One source from the points of a polyline. Their spacing should not be much longer than the edges.
/// @throws InvalidArgument (no points, a source that is not of dimension 2)
Source stroke_source(std::span<const StrokePoint> points);

/// The points of a polyline, parameterized by arclength. Weights, positions and angles follow from the lengths of the
/// segments.
/// @param points   at least 2, or 3 if closed; sources whose u axis points along the curve and whose v axis points to its left
/// @param lengths  > 0: lengths[k] is the length from point k to the next one, world units; one fewer than points, or
/// as many if closed
/// @throws InvalidArgument (counts, a length, a source that is not of dimension 2, `circle` on an open curve)
std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       const StrokeOptions& options = {});
/// The points of a polyline with user-defined coordinates.
/// @param positions  (u, v) of each point, world units; consecutive ones differ
std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       std::span<const Vec2> positions, bool closed = false);

/// One source from the points of `stroke_points`. @throws as `stroke_points`
Source stroke_source(std::span<const Source> points, std::span<const double> lengths,
                     const StrokeOptions& options = {});
Source stroke_source(std::span<const Source> points, std::span<const double> lengths, std::span<const Vec2> positions,
                     bool closed = false);

/// A point on a surface, or a position in space, which is replaced by the nearest point of the surface.
using CurvePoint = std::variant<Vec3, SurfacePoint>;

/// A curve on a surface, the source along it, and its measures.
struct SurfaceCurve {
  Source source{2};                  ///< for the heat method
  std::vector<ExactSource> samples;  ///< for `ExactGeodesics::log_map`: the midpoints of the pieces
  std::vector<double> pieces;        ///< lengths of the pieces, world units
  std::vector<Vec3> points;    ///< corners of the lines, on the surface, world units; a closed curve does not repeat
                               ///< the first
  std::optional<Frame> first;  ///< axes in the first piece: u along the curve, v to its left
  double length = 0;           ///< world units
  double gap = 0;              ///< largest distance of the polyline in space from the surface, world units
  double jump = 0;             ///< length of the longest piece, world units
  /// Number of lines between input points that are straight in space instead of shortest paths, and the reason: the message
  /// of `Surface::flat_triangles`, or that the surface does not connect their ends.
  Index straight = 0;
  std::string straight_reason;
  std::optional<StrokeOptions> shape;  ///< shape of the coordinates; none: user-defined coordinates
};

/// Joins the input points, cuts the lines into pieces of about half an edge, and projects the midpoints of the pieces to
/// the surface (`Surface::closest_point`). The lines are shortest paths, over flat faces or, on clouds, over tangent planes
/// (`shortest_line`). On clouds, points closer than two edges are joined by straight lines. On twisted polygons all lines
/// are straight in space (`SurfaceCurve::straight`); choose points so close that the lines stay near the surface.
/// @throws InvalidArgument (as `Surface::source`; faults curve_too_long: more than a million pieces, curve_too_short: fewer
/// than 2 different points, or 3 if closed, curve_turns_back at an input point, curve_one_sided: closed along a one-sided
/// band), as `stroke_source`
SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, const StrokeOptions& options = {});

/// A curve with user-defined coordinates.
/// @param positions  (u, v) of each input point, world units; linear between them; consecutive ones differ
SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, std::span<const Vec2> positions,
                        bool closed = false);

/// Radius of a map from a curve that covers all rows within `radius` of the curve, world units. The map measures distances
/// from the midpoints of the pieces, so it needs a larger radius.
double map_radius_of_curve(const SurfaceCurve& curve, double radius);

/// The map from a curve, by rows. Distances are those from the curve itself. They come from the coordinates, limited to the
/// range that the map's distances from samples of the curve allow; for maps that are not exact the range is up to half a
/// piece wider. With user-defined coordinates they are the map's own. Angles have no meaning for a curve and are left out.
/// @param radius  rows farther than this get `Status::beyond_radius`, world units; the map must cover `map_radius_of_curve`
RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve,
                          double radius = std::numeric_limits<double>::infinity());

}  // namespace ahm
