/// \file
/// A curve drawn on a surface: from a few points, in space or on the surface, to a source (see stroke.hpp).
///
/// \code
/// const ahm::CurvePoint given[] = {ahm::Vec3{0, 0, 1.2}, ahm::Row{17}, ahm::FacePoint{7, {0.2, 0.3, 0.5}}};
/// ahm::SurfaceCurve curve = ahm::draw_curve(surface, given);
/// ahm::LogMap map = solver.solve(curve.source);                  // u: arclength, v: signed distance (left > 0)
/// ahm::LogMap exact = geodesics.log_map(curve.samples);          // the same over the flat faces of a mesh
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ahm/applications/stroke.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

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
double reach_from_curve(const SurfaceCurve& curve, double radius);

/// The map from a curve by row. Its distances are those from the curve: as the coordinates have it beside the curve and in the
/// plane, within what the map's own, from samples of the curve, leave open (for exact maps; for others half a piece more). The map's own are told where the coordinates are the user's own. Angles, which mean nothing from a curve, are left out.
/// @param radius  rows farther than this are beyond it, world units; the map must reach `reach_from_curve`
RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve,
                          double radius = std::numeric_limits<double>::infinity());

}  // namespace ahm
