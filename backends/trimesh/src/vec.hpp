/// \file
/// Vectors of space and of the plane.
#pragma once

#include <cmath>

#include "ahm/util/vec.hpp"

namespace ahm::trimesh {

using ahm::operator+;
using ahm::operator-;
using ahm::operator*;
using ahm::cross;
using ahm::dot;
using ahm::norm;
using ahm::normalized;

/// A vector of the plane, or a complex number.
struct Vec2 {
  double x = 0, y = 0;
};

inline Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
/// Product of complex numbers.
inline Vec2 operator*(Vec2 a, Vec2 b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }
inline Vec2 conj(Vec2 a) { return {a.x, -a.y}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }
inline Vec2 normalized(Vec2 a) { return 1.0 / norm(a) * a; }
inline Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// Angle from a counter-clockwise to b, in (-pi, pi].
inline double angle_between(Vec2 a, Vec2 b) { return std::atan2(cross(a, b), dot(a, b)); }

}  // namespace ahm::trimesh
