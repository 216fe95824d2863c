/// \file
/// How a curved surface focuses the front of the points that are equally far from one point.
///
/// At distance r the front is a circle of curvature 1/r in the plane. Elsewhere its geodesic curvature k obeys the Riccati
/// equation along each way, K being the Gaussian curvature [DoC92]:
///
///     k' = -k^2 - K,    k = 1/r - m/r^2    hence    m' = K r^2 + m^2/r^2,   m = 0 at the point
///
/// m is the focusing: zero in the plane, K r^3 / 3 near the point. It tells by how much the distances along a side are not those
/// of the circle through its ends.
#pragma once

#include <algorithm>
#include <cmath>

namespace ahm {

/// The curvature of a front does not depart from that of the circle by more than this over the length of a side or step:
/// where it would, the mesh is too coarse to tell.
inline constexpr double most_bent = 0.2;
/// `beyond_circle` is no more than this share of the side, nor of the distance.
inline constexpr double most_beyond_circle = most_bent / 8;

/// The focusing at distance `to`, from that at distance `from`: the front goes on as over a plane, exactly, and is bent by the
/// curvature on the way.
inline double focusing_after(double focusing, double from, double to, double curvature) {
  const double step = to - from;
  if (!(step > 0)) return focusing;
  const double most = most_bent * to * to / step;
  const double spared = from > 0 ? 1 - focusing * step / (from * to) : 1;  // none left: a focus lies between
  const double over_plane = spared > 0 ? focusing / spared : most;
  const double bent = std::clamp(over_plane + curvature * step * (to * to + to * from + from * from) / 3, -most, most);
  return std::isfinite(bent) ? bent : 0;  // lengths beyond the squares of numbers
}

/// By how much the distance of a point on a side is more than on the circle through its ends.
/// @param distance      of the point
/// @param share         of the side, from one end to the point
/// @param squared_sine  of the angle between the way and the side
inline double beyond_circle(double focusing, double distance, double side, double share, double squared_sine) {
  if (!(distance > 0)) return 0;
  const double most = most_bent * std::min(1.0, distance / side);
  const double bend = std::clamp(focusing / (distance * distance) * side, -most, most);
  return 0.5 * share * (1 - share) * squared_sine * side * bend;
}

}  // namespace ahm
