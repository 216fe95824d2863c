/// \file
/// A curve on a surface, cut into pieces.
///
/// \code
/// ahm::SurfaceCurve curve;
/// for (const ahm::CurvePiece& piece : ahm::cut_curve(surface, given, false, curve)) use(piece.point, piece.length);
/// \endcode
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ahm/applications/surface_curve.hpp"

namespace ahm {

/// A piece of the curve, by its middle.
struct CurvePiece {
  SurfacePoint point;
  Vec3 arriving, leaving;  ///< directions of the curve there of the segments that end and begin there
  std::size_t after;       ///< which of the given points
  double along;            ///< of the line to the next one, in (0, 1)
  double length;
};

/// Joins the given points and cuts the lines (see `draw_curve`).
/// @param curve  gets points, pieces, length, gap, jump and what lines are straight
/// @throws InvalidArgument (as `draw_curve`)
std::vector<CurvePiece> cut_curve(const Surface& surface, std::span<const CurvePoint> given, bool closed,
                                  SurfaceCurve& curve);

}  // namespace ahm
