/// \file
/// Arithmetic on points and vectors of 3-space.
#pragma once

#include <cmath>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalized(const Vec3& a) { return (1.0 / norm(a)) * a; }

/// Orthonormal axes of the plane with a unit normal: x is the projected first coordinate axis of space (the second
/// where the normal is close to the first), y = normal x x.
struct PlaneAxes {
  explicit PlaneAxes(const Vec3& normal) {
    const Vec3 axis = std::abs(normal[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    x = normalized(axis - dot(axis, normal) * normal);
    y = cross(normal, x);
  }
  Vec3 x, y;
};

}  // namespace ahm::pointcloud
