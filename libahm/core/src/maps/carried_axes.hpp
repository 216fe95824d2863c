/// \file
/// The axes of a source along a geodesic path.
#pragma once

#include <array>

#include "ahm/types.hpp"

namespace ahm {

/// The source's axes, parallel transported along the path to a vertex: the rotation (or reflection) that maps the direction of departure to
/// that of arrival; row major.
inline std::array<double, 4> carried_axes(const Vec2& departure, const Vec2& arrival, bool mirrored) {
  const double side = mirrored ? -1 : 1;
  // rotation(arrival) diag(1, side) rotation(-departure)
  const Vec2 u{arrival[0] * departure[0] + side * arrival[1] * departure[1],
               arrival[1] * departure[0] - side * arrival[0] * departure[1]};
  return {u[0], -side * u[1], u[1], side * u[0]};
}

}  // namespace ahm
