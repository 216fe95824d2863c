/// \file
/// Log maps of the unit sphere against their closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm::bench {

struct SphereError {
  double rms = 0;         ///< of the vector error over d <= 0.9 pi
  double hemisphere = 0;  ///< largest vector error over d < pi / 2
  double angle = 0;       ///< root mean square over d <= 0.9 pi, radians
  int missing = 0;        ///< points with d <= 0.9 pi that have no coordinates
};

inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Errors of (u, v) at every point, seen from point `source` in its frame.
inline SphereError sphere_error(std::span<const Vec3> points, std::span<const double> u, std::span<const double> v,
                                Index source, const Frame& frame) {
  SphereError result;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::acos(std::clamp(dot(points[i], points[source]), -1.0, 1.0));
    if (distance > 0.9 * std::numbers::pi || static_cast<Index>(i) == source) continue;
    const double x = dot(frame.x, points[i]), y = dot(frame.y, points[i]), r = std::hypot(x, y);
    const double exact_u = x / r * distance, exact_v = y / r * distance;
    const double error = std::hypot(u[i] - exact_u, v[i] - exact_v);
    if (!std::isfinite(error)) {
      ++result.missing;
      continue;
    }
    result.rms += error * error;
    result.angle += std::pow(std::atan2(v[i] * exact_u - u[i] * exact_v, u[i] * exact_u + v[i] * exact_v), 2);
    if (distance < std::numbers::pi / 2) result.hemisphere = std::max(result.hemisphere, error);
    ++count;
  }
  return {std::sqrt(result.rms / count), result.hemisphere, std::sqrt(result.angle / count), result.missing};
}

}  // namespace ahm::bench
