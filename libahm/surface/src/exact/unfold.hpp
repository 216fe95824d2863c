/// \file
/// The plane of one face seen from the next: frames of half-edges (HalfRecord) and how to change them.
#pragma once

#include <cmath>
#include <utility>

#include "ahm/surface/exact/polyhedral_surface.hpp"

namespace ahm::exact {

/// A point or source in the frame of a half-edge.
struct Place {
  double x = 0, y = 0;
};

inline double distance(Place a, Place b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }
inline Place apex(const HalfRecord& r) { return {r.apex_x, r.apex_y}; }

/// In the frame of the half-edge beyond the left side, which runs from the tail to the apex (glued without mirroring).
inline Place beyond_left(const HalfRecord& r, Place p) {
  const double scale = 1 / r.left;
  return {(p.x * r.apex_x + p.y * r.apex_y) * scale, (p.y * r.apex_x - p.x * r.apex_y) * scale};
}

/// In the frame of the half-edge beyond the right side, which runs from the apex to the head (glued without mirroring).
inline Place beyond_right(const HalfRecord& r, Place p) {
  const double scale = 1 / r.right, c = (r.length - r.apex_x) * scale, s = r.apex_y * scale, x = p.x - r.length;
  return {r.right + x * c - p.y * s, x * s + p.y * c};
}

/// In the frame of the next half-edge of the same face.
inline Place in_next(const HalfRecord& r, Place p) {
  const Place q = beyond_right(r, p);
  return {r.right - q.x, -q.y};
}

/// In the frame of the previous half-edge of the same face.
inline Place in_previous(const HalfRecord& r, Place p) {
  const Place q = beyond_left(r, p);
  return {r.left - q.x, -q.y};
}

}  // namespace ahm::exact
