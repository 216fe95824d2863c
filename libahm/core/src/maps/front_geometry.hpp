/// \file
/// One step of an unfolding front: a point at known distances from two corners of a triangle, beyond the side between them, seen from
/// the third.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
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

/// u of a vertex, at least 1.
/// @param straight  T0 > 0
/// @param upwind    the neighbours from which the front comes, one per axis at most, at least one in all: the `length` of the edge, the
///                  `cosine` between it, towards the vertex, and the straight line, and the `factor` u; in another order afterwards
template <class Upwind>
double eikonal_factor(double straight, std::span<Upwind> upwind) {
  const auto slope = [&](const Upwind& k) { return straight / k.length + k.cosine; };
  const auto offset = [&](const Upwind& k) { return straight / k.length * k.factor; };
  // An axis counts where the front comes along it, which is from this u on.
  const auto begin = [&](const Upwind& k) { return slope(k) > 0 ? offset(k) / slope(k) : INFINITY; };
  std::sort(upwind.begin(), upwind.end(), [&](const Upwind& a, const Upwind& b) { return begin(a) < begin(b); });
  double u = INFINITY, ss = 0, so = 0, oo = -1;
  for (const Upwind& k : upwind) {
    if (!(u > begin(k))) break;
    const double s = slope(k), o = offset(k);
    ss += s * s, so += s * o, oo += o * o;
    u = (so + std::sqrt(std::max(0.0, so * so - ss * oo))) / ss;
  }
  return std::max(1.0, u);
}

/// Whether edges are all at right angles or along each other.
/// @param axis  to be filled, per edge: the first one along the same line
inline bool find_axes(const Star& star, std::vector<std::size_t>& axis) {
  constexpr double same = 1e-9;
  axis.resize(star.degree());
  for (std::size_t e = 0; e < star.degree(); ++e) {
    axis[e] = e;
    for (std::size_t k = 0; k < e; ++k) {
      double product = 0;
      for (int a = 0; a < star.dimension; ++a) product += star.log(e)[a] * star.log(k)[a];
      const double cosine = std::abs(product) / (length(star.log(e)) * length(star.log(k)));
      if (cosine > 1 - same)
        axis[e] = axis[k];
      else if (!(cosine < same))
        return false;
    }
  }
  return star.degree() > 0;
}

/// The curvature of a front does not depart from that of the circle by more than this over the length of a side or step:
/// where it would, the mesh is too coarse to tell.
inline constexpr double max_bend = 0.2;
/// `curvature_correction` is no more than this share of the side, nor of the distance.
inline constexpr double max_curvature_correction = max_bend / 8;

/// The focusing at distance `to`, from that at distance `from`: the front goes on as over a plane, exactly, and is bent by the
/// curvature on the way.
inline double focusing_after(double focusing, double from, double to, double curvature) {
  const double step = to - from;
  if (!(step > 0)) return focusing;
  const double most = max_bend * to * to / step;
  const double spared = from > 0 ? 1 - focusing * step / (from * to) : 1;  // none left: a focus lies between
  const double over_plane = spared > 0 ? focusing / spared : most;
  const double bent = std::clamp(over_plane + curvature * step * (to * to + to * from + from * from) / 3, -most, most);
  return std::isfinite(bent) ? bent : 0;  // lengths beyond the squares of numbers
}

/// By how much the curvature of a front is less than that of the circle, times the length of a side.
/// @param distance  of the front
inline double bend_along(double side, double focusing, double distance) {
  if (!(distance > 0)) return 0;
  const double most = max_bend * std::min(1.0, distance / side);
  return std::clamp(focusing / (distance * distance) * side, -most, most);
}

/// By how much the distance of a point on a side is more than on the circle through its ends.
/// @param bend          `bend_along` the side
/// @param share         of the side, from one end to the point
/// @param squared_sine  of the angle between the way and the side
inline double curvature_correction(double bend, double side, double share, double squared_sine) {
  return 0.5 * share * (1 - share) * squared_sine * side * bend;
}

/// Where the ray to a point beyond a side crosses it, as a share of the side: a front that is less bent than the circle has rays
/// that diverge less, and this one crosses farther from the middle.
/// @param share   where the ray from the center of the circle crosses
/// @param beyond  length of the ray beyond the side
inline double bent_crossing(double share, double bend, double side, double beyond) {
  return std::clamp(share + (share - 0.5) * bend * beyond / side, 0.0, 1.0);
}

}  // namespace ahm
