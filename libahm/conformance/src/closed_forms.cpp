#include "ahm/conformance/closed_forms.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/conformance/vectors.hpp"

namespace ahm::test {

Vec2 sphere_log(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& q) {
  const double u = dot(x, q), v = dot(y, q), sine = std::hypot(u, v), angle = std::atan2(sine, dot(p, q));
  return sine > 0 ? Vec2{angle / sine * u, angle / sine * v} : Vec2{0, 0};
}

double sphere_distance(const Vec3& p, const Vec3& q) { return std::acos(std::clamp(dot(p, q), -1.0, 1.0)); }

SphereError sphere_error(std::span<const Vec3> points, std::span<const double> u, std::span<const double> v,
                         Index source, const Vec3& x, const Vec3& y, double reach) {
  SphereError result;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 exact = sphere_log(points[source], x, y, points[i]);
    const double distance = std::hypot(exact[0], exact[1]);
    if (distance > reach || static_cast<Index>(i) == source) continue;
    const double error = std::hypot(u[i] - exact[0], v[i] - exact[1]);
    if (!std::isfinite(error)) {
      ++result.missing;
      continue;
    }
    const double angle = std::atan2(v[i] * exact[0] - u[i] * exact[1], u[i] * exact[0] + v[i] * exact[1]);
    result.rms += error * error;
    result.angle += angle * angle;
    if (distance < std::numbers::pi / 2) result.hemisphere = std::max(result.hemisphere, error);
    ++count;
  }
  result.rms = std::sqrt(result.rms / count);
  result.angle = std::sqrt(result.angle / count);
  return result;
}

}  // namespace ahm::test
