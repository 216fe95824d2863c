/// \file
/// Vectors in space, for shapes and their tests.
#pragma once

#include <cmath>

#include "ahm/types.hpp"

namespace ahm::test {

inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 times(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// The unit vector along a vector.
inline Vec3 unit(const Vec3& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}
/// The component of a vector perpendicular to `normal`, which has length 1.
inline Vec3 tangential(const Vec3& v, const Vec3& normal) { return minus(v, times(dot(v, normal), normal)); }

}  // namespace ahm::test
