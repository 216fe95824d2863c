/// \file
/// A curve drawn on a surface: from what the user wrote to a source for `LogMapSolver`.
#pragma once

#include <string>
#include <vector>

#include "ahm/applications/stroke.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// A curve on the surface and what it amounts to.
struct Curve {
  Source source{2};
  std::vector<Vec3> points;    ///< as sampled, on the surface
  std::optional<Frame> first;  ///< u along the curve, v left of it, at its first point
  double length = 0;
  double gap = 0;   ///< largest distance of the polyline in space from the surface
  double jump = 0;  ///< largest distance between consecutive points
};

/// Joins the given points by straight lines, cuts these into pieces of half a mean edge length at the most, and takes
/// the nearest points of the surface: points in faces of meshes; of clouds, points of the tangent plane of the nearest
/// vertex, which carries them with its offset.
/// @throws InvalidArgument
Curve draw_curve(const Input& input, const std::vector<SourceSpec>& given, const StrokeOptions& options);

}  // namespace ahm::app
