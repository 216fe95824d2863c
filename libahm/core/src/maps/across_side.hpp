/// \file
/// One step of an unfolding front: a point at known distances from two corners of a triangle, beyond the side between them, seen from
/// the third.
#pragma once

#include <algorithm>
#include <cmath>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// Of a ray shorter than this share of a side nobody knows the direction.
inline constexpr double least_ray = 1e-6;

/// Where a point lies in the layout of a triangle with a at 0, b at (ab, 0) and c at (cx, cy) above: at (x, -depth); the square of
/// its distance from c, and where the line to c crosses the side, if `found`.
struct Across {
  double squared, x, depth, share;
  bool found;

  double length() const { return std::sqrt(squared); }
};

/// Of a point at distances `from_a` and `from_b` below the side ab; not found where c is no nearer than the root of `limit`, or
/// where the straight line to the point does not cross that side. It is asked a dozen times for each vertex, mostly in vain for
/// any of these reasons: so all is computed, and decided at once.
[[gnu::always_inline]] inline Across across_side(double from_a, double from_b, double ab, double cx, double cy,
                                                 double limit, double missed) {
  // Sides that are shorter than this share of the other two, or of a distance, no longer tell where the point lies.
  constexpr double shortest = 1e-6, shortest_far_away = 1e-13;
  const double x = 0.5 * (ab + (from_a - from_b) * (from_a + from_b) / ab);
  const double squared_y = (from_a - x) * (from_a + x), along = (cx - x) * (cx - x) + cy * cy + squared_y;
  const double depth = std::sqrt(squared_y > 0 ? squared_y : 0.0), height = cy + depth;
  const double at_side = x * cy + cx * depth;  // where the line crosses, times height
  const double squared = (cx - x) * (cx - x) + height * height;
  const bool found = (ab > shortest * std::max(std::abs(cx), cy)) & (ab > shortest_far_away * from_a) &
                     (squared_y >= -1e-14 * from_a * from_a) & (along < limit) & (squared < limit) &
                     (at_side >= -missed * ab * height) & (at_side <= (1 + missed) * ab * height);
  return {squared, x, depth, std::clamp(at_side / (ab * height), 0.0, 1.0), found};
}

/// Whether c is certainly no nearer to that point than the root of `limit`: `along` of `across_side`, without its division. So it
/// is of most vertices that the front has passed.
inline bool is_beyond(double from_a, double from_b, double ab, double cx, double cy, double limit) {
  // Sums of products may be off by less than this share of the largest, unless they are below `least_cube`.
  constexpr double rounding = 1e-12, least_cube = 1e-280;
  const double twice_x_ab = ab * ab + (from_a - from_b) * (from_a + from_b),
               squared = cx * cx + cy * cy + from_a * from_a;
  const double least = squared - limit - rounding * (squared + from_a * from_a + limit + ab * ab);
  return (least * ab > cx * twice_x_ab + least_cube) & (std::abs(twice_x_ab) <= 2.1 * ab * from_a);
}

/// `v` turned as the ray `from` must be to become the ray `to`, the other way round if `side` is -1; unit length.
inline Vec2 turned_with(const Vec2& v, const Vec2& from, const Vec2& to, double side) {
  const double along = dot(from, to), across = side * cross(from, to), by = length(Vec2{along, across});
  return {(v[0] * along - v[1] * across) / by, (v[1] * along + v[0] * across) / by};
}

/// A direction at a point of which two neighbors have given an estimate each.
struct DirectionAcross {
  Vec2 direction;
  double difference;  ///< of the two estimates, radians
};

/// The direction at the point of a ray that crosses the side, from those of the rays to a and b: the mean of the
/// two estimates, weighted by how near the ray crosses; that of the nearer end where they differ too much to be of one front.
/// @param share    of the side where the ray crosses
/// @param towards  a place on the ray, in the layout of the triangle
/// @param side     1: a, b, c counterclockwise; -1: clockwise
inline DirectionAcross direction_across(const Across& point, double share, const Vec2& towards, double ab,
                                        const Vec2& to_a, const Vec2& to_b, double side) {
  // Rays to a and b that differ by more than this many times the angle at which the side is seen come along two ways, as around
  // a tube, and there is none between them.
  constexpr double two_ways = 6;
  const double x = point.x, depth = point.depth;
  const Vec2 a{-x, depth}, b{ab - x, depth}, c{towards[0] - x, towards[1] + depth};
  const Vec2 by_a = turned_with(to_a, a, c, side), by_b = turned_with(to_b, b, c, side);
  if (!(length(a) > least_ray * ab) || std::isnan(to_a[0])) return {by_b, 0};
  if (!(length(b) > least_ray * ab) || std::isnan(to_b[0])) return {by_a, 0};
  const double difference = length(Vec2{by_a[0] - by_b[0], by_a[1] - by_b[1]});
  if (difference > two_ways * ab / point.length()) return {share < 0.5 ? by_a : by_b, difference};
  const Vec2 sum{(1 - share) * by_a[0] + share * by_b[0], (1 - share) * by_a[1] + share * by_b[1]};
  const double size = length(sum);
  return {size > 0 ? Vec2{sum[0] / size, sum[1] / size} : by_a, difference};
}

}  // namespace ahm
