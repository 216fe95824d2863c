/// \file
/// Points and curves of the options, moved to the surface and to the mesh.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "surface_curve.hpp"
#include "tool_path/passes.hpp"

namespace ahm {

/// Points of curves that are farther than this from the surface are rejected, in spacings.
inline constexpr double largest_curve_distance = 0.5;

/// @param name  of the value, for messages
/// @throws InvalidArgument (not finite, or not > 0)
void check_positive(const std::string& name, double value);

/// The point of an option on the surface. A position is moved to the nearest point.
/// @param name   of the point, for messages
/// @param fault  name of the error, a literal
/// @throws InvalidArgument (a position farther than half a spacing)
SurfacePoint surface_point(const Surface& surface, const CurvePoint& point, double spacing, const std::string& name,
                           std::string_view fault);

/// The points of a curve, joined on the surface.
/// @param name   of the curve, for messages: "seed"
/// @throws InvalidArgument (as `surface_point`)
SurfaceCurve drawn_curve(const Surface& surface, std::span<const Vec3> positions, bool closed, double spacing,
                         const std::string& name, std::string_view fault);

/// A curve in space, moved to the mesh.
/// @throws InvalidArgument (not in the region; fault "curve_disconnected": points in different components)
MeshCurve on_mesh(const PathDomain& domain, std::span<const Vec3> points, bool closed, double spacing,
                  const std::string& name, std::string_view fault);

}  // namespace ahm
