/// \file
/// The plane of one face seen from the next: frames of half-edges (HalfRecord) and how to change them.
#pragma once

#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::exact {

/// A point or source in the frame of a half-edge.
using Place = Vec2;

inline double distance(const Place& a, const Place& b) { return norm(a - b); }
inline Place apex(const HalfRecord& r) { return {r.apex_x, r.apex_y}; }

/// In the frame of the half-edge beyond the left side, which runs from the tail to the apex (glued without mirroring).
inline Place beyond_left(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.left;
  return {(p[0] * r.apex_x + p[1] * r.apex_y) * scale, (p[1] * r.apex_x - p[0] * r.apex_y) * scale};
}

/// In the frame of the half-edge beyond the right side, which runs from the apex to the head (glued without mirroring).
inline Place beyond_right(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.right, c = (r.length - r.apex_x) * scale, s = r.apex_y * scale, x = p[0] - r.length;
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

}  // namespace ahm::exact
