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

/// By how much the curvature of a front is less than that of the circle, times the length of a side.
/// @param distance  of the front
inline double bend_along(double side, double focusing, double distance) {
  if (!(distance > 0)) return 0;
  const double most = most_bent * std::min(1.0, distance / side);
  return std::clamp(focusing / (distance * distance) * side, -most, most);
}

/// By how much the distance of a point on a side is more than on the circle through its ends.
/// @param bend          `bend_along` the side
/// @param share         of the side, from one end to the point
/// @param squared_sine  of the angle between the way and the side
inline double beyond_circle(double bend, double side, double share, double squared_sine) {
  return 0.5 * share * (1 - share) * squared_sine * side * bend;
}

/// Where the ray to a point beyond a side crosses it, as a share of the side: a front that is less bent than the circle has rays
/// that diverge less, and this one crosses farther from the middle.
/// @param share   where the ray from the center of the circle crosses
/// @param beyond  length of the ray beyond the side
inline double bent_crossing(double share, double bend, double side, double beyond) {
  return std::clamp(share + (share - 0.5) * bend * beyond / side, 0.0, 1.0);
}

}  // namespace ahm
