/// \file
/// The plane of one face seen from the next: frames of half-edges (HalfRecord) and how to change them.
#pragma once

#include <cmath>

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::exact {

/// A point or source in the frame of a half-edge.
using Place = Vec2;

inline double distance(const Place& a, const Place& b) { return norm(a - b); }
/// In [0, pi].
inline double angle_between(const Vec2& a, const Vec2& b) { return std::abs(std::atan2(cross(a, b), dot(a, b))); }
inline Place apex(const HalfRecord& r) { return {r.apex_x, r.apex_y}; }

/// In the frame of the half-edge beyond the left side, which runs from the tail to the apex (glued without mirroring).
inline Place beyond_left(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.left;
  return {(p[0] * r.apex_x + p[1] * r.apex_y) * scale, (p[1] * r.apex_x - p[0] * r.apex_y) * scale};
}

/// In the frame of the half-edge beyond the right side, which runs from the apex to the head (glued without mirroring).
inline Place beyond_right(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.right, c = r.back_x * scale, s = r.apex_y * scale, x = p[0] - r.length;
  return {r.right + x * c - p[1] * s, x * s + p[1] * c};
}

/// In the frame of the next half-edge of the same face.
inline Place in_next(const HalfRecord& r, const Place& p) {
  const Place q = beyond_right(r, p);
  return {r.right - q[0], -q[1]};
}

/// In the frame of the previous half-edge of the same face.
inline Place in_previous(const HalfRecord& r, const Place& p) {
  const Place q = beyond_left(r, p);
  return {r.left - q[0], -q[1]};
}

/// Where the ray from an origin below a half-edge to a point above crosses its line.
inline double crossing_to(const Place& from, const Place& at) {
  return from[0] - (at[0] - from[0]) * from[1] / (at[1] - from[1]);
}

/// Where the ray from an origin below a half-edge through t on it hits the line of the left side (from the tail on) or of
/// the right side (from the apex on).
inline double hit_left(const HalfRecord& r, const Place& from, double t) {
  const double down = -from[1];
  return t * down / (down * r.apex_x + (from[0] - t) * r.apex_y) * r.left;
}
inline double hit_right(const HalfRecord& r, const Place& from, double t) {
  const double down = -from[1], u = r.length - t;
  return r.right - u * down / (down * r.back_x + (r.length - from[0] - u) * r.apex_y) * r.right;
}

/// Points of these sides.
inline Place on_left(const HalfRecord& r, double t) {
  const double part = t / r.left;
  return {part * r.apex_x, part * r.apex_y};
}
inline Place on_right(const HalfRecord& r, double t) {
  const double part = (r.right - t) / r.right;
  return {r.length - part * r.back_x, part * r.apex_y};
}

}  // namespace ahm::exact
