/// \file
/// Axes of tangent planes.
#pragma once

#include <cmath>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {

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
