/// \file
/// The unit sphere's log map in closed form, and the error of a computed one.
///
/// \code
/// const Vec2 exact = sphere_log(p, frame.x, frame.y, q);
/// const SphereError error = sphere_error(points, map.u, map.v, source, frame.x, frame.y);
/// EXPECT_LT(error.rms, h);
/// \endcode
#pragma once

#include <numbers>
#include <span>

#include "ahm/types.hpp"

namespace ahm::test {

/// Log map at p with tangent axes x, y. Zero at p, and at -p, where the shortest direction is not unique.
/// @param p, q  unit vectors
/// @param x, y  of equal length, perpendicular to p and to each other
Vec2 sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q);

/// Length of the shorter arc between two unit vectors.
double sphere_distance(const Vec3& p, const Vec3& q);

struct SphereError {
  double rms = 0;         ///< root mean square of the vector error, over distances up to `reach`
  double hemisphere = 0;  ///< largest vector error over distances < pi / 2
  double angle = 0;       ///< root mean square of the angular error over distances up to `reach`, radians
  int missing = 0;        ///< number of points within `reach` without coordinates
};

/// Errors of (u, v) at the points of the unit sphere, for a map from point `source` with the axes x, y. The source itself
/// is left out.
SphereError sphere_error(std::span<const Vec3> points, std::span<const double> u, std::span<const double> v,
                         Index source, const Vec3& x, const Vec3& y, double reach = 0.9 * std::numbers::pi);

}  // namespace ahm::test
