/// \file
/// Vectors of the plane as complex numbers.
#pragma once

#include <cmath>

#include "ahm/util/vec.hpp"

namespace ahm::trimesh {

inline Vec2 product(const Vec2& a, const Vec2& b) { return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]}; }
inline Vec2 conj(const Vec2& a) { return {a[0], -a[1]}; }
inline Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// Angle from a counter-clockwise to b, in (-pi, pi].
inline double angle_between(const Vec2& a, const Vec2& b) { return std::atan2(cross(a, b), dot(a, b)); }

}  // namespace ahm::trimesh
