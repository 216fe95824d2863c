/// \file
/// One step of an unfolding front: computes the distance of the third corner of a triangle from a point whose distances from the other two
/// corners are known.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// Rays shorter than this share of a side have no reliable direction.
inline constexpr double least_ray = 1e-6;

/// Bound of m/d^2 times the length of a side or step. On a mesh where it would be larger, the triangles are too large for the correction.
inline constexpr double max_bend = 0.2;

/// A source point in the layout of a triangle with a at 0, b at (ab, 0) and c at (cx, cy), cy > 0. The point is at (x, -depth),
/// `squared` is its squared distance from c. The line to c crosses the side ab at `share`: 0 at a, 1 at b. All are valid if `found`.
struct Across {
  double squared, x, depth, share;
  bool found;

  double length() const { return std::sqrt(squared); }
};

/// Locates a point below the side ab at the distances `from_a` and `from_b`. Not found if the squared distance of c is not below
/// `limit`, or if the straight line from the point to c misses the side by more than the share `missed`. It is called a dozen times
/// per vertex and mostly finds nothing, for any of these reasons. Therefore it computes everything and branches once.
[[gnu::always_inline]] inline Across across_side(double from_a, double from_b, double ab, double cx, double cy,
                                                 double limit, double missed) {
  // Sides shorter than these shares of the other two sides, or of a distance, do not determine where the point lies.
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

/// Whether the squared distance of c from the point is certainly not below `limit`. It evaluates `along` of `across_side` without the
/// division. This is true for most vertices that the front has passed.
inline bool is_beyond(double from_a, double from_b, double ab, double cx, double cy, double limit) {
  // Sums of products have a relative error below `rounding`, unless they are below `least_cube`.
  constexpr double rounding = 1e-12, least_cube = 1e-280;
  const double twice_x_ab = ab * ab + (from_a - from_b) * (from_a + from_b),
               squared = cx * cx + cy * cy + from_a * from_a;
  const double least = squared - limit - rounding * (squared + from_a * from_a + limit + ab * ab);
  return (least * ab > cx * twice_x_ab + least_cube) & (std::abs(twice_x_ab) <= 2.1 * ab * from_a);
}

/// Rotates `v` by the angle from the ray `from` to the ray `to`, or by its negative if `side` is -1. Unit length.
inline Vec2 turned_with(const Vec2& v, const Vec2& from, const Vec2& to, double side) {
  const double along = dot(from, to), across = side * cross(from, to), by = length(Vec2{along, across});
  return {(v[0] * along - v[1] * across) / by, (v[1] * along + v[0] * across) / by};
}

/// The mean of two estimates of a direction.
struct DirectionAcross {
  Vec2 direction;
  double difference;  ///< angle between the two estimates, radians
};

/// The direction in which a ray that crosses the side leaves the source point. The directions of the rays to a and b give one
/// estimate each. The result is their mean, weighted by how near the ray crosses. If they differ too much to belong to one front, it
/// is the estimate of the nearer end.
/// @param share     where the ray crosses the side: 0 at a, 1 at b
/// @param towards   a point on the ray, in the layout of the triangle
/// @param side      1: a, b, c counterclockwise; -1: clockwise
/// @param bend      `bend_along` of the side
/// @param widening  ln(J / d) at b minus that at a (`widening_between`)
inline DirectionAcross direction_across(const Across& point, double share, const Vec2& towards, double ab,
                                        const Vec2& to_a, const Vec2& to_b, double side, double bend, double widening) {
  // If the directions differ by more than this many times the angle that the side subtends at the point, the rays to a and b arrive along
  // two different paths, for example around a tube, and no ray passes between them.
  constexpr double two_ways = 6;
  const double x = point.x, depth = point.depth;
  const Vec2 a{-x, depth}, b{ab - x, depth}, c{towards[0] - x, towards[1] + depth};
  const Vec2 by_a = turned_with(to_a, a, c, side), by_b = turned_with(to_b, b, c, side);
  if (!(length(a) > least_ray * ab) || std::isnan(to_a[0])) return {by_b, 0};
  if (!(length(b) > least_ray * ab) || std::isnan(to_b[0])) return {by_a, 0};
  const double difference = length(Vec2{by_a[0] - by_b[0], by_a[1] - by_b[1]});
  if (difference > two_ways * ab / point.length()) return {share < 0.5 ? by_a : by_b, difference};
  const Vec2 sum{(1 - share) * by_a[0] + share * by_b[0], (1 - share) * by_a[1] + share * by_b[1]};
  // The weights are exact to first order. The second order: the angle at the source grows by sin(alpha) / J per length of the side, with the
  // angle alpha between ray and side. `decrease` is the decrease of ln(sin(alpha) / J) along the side, `circle_decrease` that for a circle.
  const double ray = length(c), cosine = c[0] / ray, circle = cross(a, b) / (length(a) * length(b));
  const double angle = circle + side * cross(by_a, by_b), circle_decrease = 2 * cosine * ab / ray;
  const double across_ray = std::clamp(widening + bend * cosine, -max_bend, max_bend);
  const double decrease = circle_decrease - 2 * bend * cosine + across_ray;
  const double turn = 0.5 * side * share * (1 - share) * (angle * decrease - circle * circle_decrease);
  const Vec2 turned{sum[0] - turn * sum[1], sum[1] + turn * sum[0]};
  const double size = length(turned);
  return {size > 0 ? Vec2{turned[0] / size, turned[1] / size} : by_a, difference};
}

/// Solves the factored eikonal equation |grad(T0 u)| = 1 [FLZ09] at a vertex; T0 is the straight-line distance:
///
///     sum_k (T0 (u - u_k) / h_k + c_k u)^2 = 1
///
/// @param straight  T0 > 0
/// @param upwind    the neighbors k from which the front comes, at least one, at most one per axis: the `length` h_k of the edge, the
///                  `cosine` c_k between the edge (towards the vertex) and the straight line, and the `factor` u_k. The order changes
/// @return u, at least 1
template <class Upwind>
double eikonal_factor(double straight, std::span<Upwind> upwind) {
  const auto slope = [&](const Upwind& k) { return straight / k.length + k.cosine; };
  const auto offset = [&](const Upwind& k) { return straight / k.length * k.factor; };
  // The front comes along an axis if u is above this value.
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

/// Whether any two edges are orthogonal or parallel.
/// @param axis  output: for each edge the number of the first edge parallel to it
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

// The curvature of the front at distance d is k = 1/d - m/d^2, where m is the focusing: m' = K d^2 + m^2/d^2 (docs/concepts/accuracy.md).

/// Bound of `curvature_correction` as a share of the side and of the distance.
inline constexpr double max_curvature_correction = max_bend / 8;

/// m at the distance `to`, computed from m at the distance `from`. The solution over a plane (K = 0) is exact; the integral of K d^2
/// is added.
inline double focusing_after(double focusing, double from, double to, double curvature) {
  const double step = to - from;
  if (!(step > 0)) return focusing;
  const double most = max_bend * to * to / step;
  const double spared = from > 0 ? 1 - focusing * step / (from * to) : 1;  // <= 0: there is a focus in between
  const double over_plane = spared > 0 ? focusing / spared : most;
  const double bent = std::clamp(over_plane + curvature * step * (to * to + to * from + from * from) / 3, -most, most);
  return std::isfinite(bent) ? bent : 0;  // the squares of lengths may overflow
}

/// Change of ln(J / d), where J is the width of the front per angle at the source, J' / J = k; the integral of -m/d^2.
inline float widening_between(double from, double focusing, double to, double focusing_there) {
  const double here = from > 0 ? focusing / (from * from) : 0, there = to > 0 ? focusing_there / (to * to) : 0;
  const double change = 0.5 * (here + there) * (from - to);
  return std::isfinite(change) ? static_cast<float>(change) : 0;  // the squares of lengths may underflow
}

/// m/d^2 times the length of a side: the difference between the curvature of a circle and that of the front.
/// @param distance  d, distance of the front
inline double bend_along(double side, double focusing, double distance) {
  if (!(distance > 0)) return 0;
  const double most = max_bend * std::min(1.0, distance / side);
  return std::clamp(focusing / (distance * distance) * side, -most, most);
}

/// The distance of a point on a side minus its distance if the front were a circle.
/// @param bend          `bend_along` of the side
/// @param share         position of the point on the side: 0 at one end, 1 at the other
/// @param squared_sine  squared sine of the angle between the path and the side
inline double curvature_correction(double bend, double side, double share, double squared_sine) {
  return 0.5 * share * (1 - share) * squared_sine * side * bend;
}

/// Where the ray to a point beyond a side crosses the side, as a share of it. The rays of a front that is less curved than a circle diverge
/// less, so the ray crosses farther from the middle.
/// @param share   where the ray crosses if the front is a circle
/// @param beyond  length of the ray beyond the side
inline double bent_crossing(double share, double bend, double side, double beyond) {
  return std::clamp(share + (share - 0.5) * bend * beyond / side, 0.0, 1.0);
}

}  // namespace ahm
