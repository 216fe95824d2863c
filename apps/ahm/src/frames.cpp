#include "frames.hpp"

#include <cmath>

namespace ahm::app {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

Frame turned(const Frame& frame, const Vec3& direction) {
  const double a = dot(direction, frame.x), b = dot(direction, frame.y);
  const double length = std::hypot(a, b);
  Frame result = frame;
  for (std::size_t c = 0; c < 3; ++c) result.x[c] = (a * frame.x[c] + b * frame.y[c]) / length;
  result.y = cross(frame.normal, result.x);
  return result;
}

}  // namespace ahm::app
