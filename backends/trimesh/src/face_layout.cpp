#include "face_layout.hpp"

#include <algorithm>

namespace ahm::trimesh {
namespace {

/// The layout with side 0 along x whose other sides have the given x components and height y.
FaceLayout turned_to_x(double length, double x1, double x2, double y) {
  return {Vec2{length, 0}, Vec2{x1, y}, Vec2{x2, -y}};
}

}  // namespace

FaceLayout layout_of_positions(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 s0 = b - a, s1 = c - b, s2 = a - c;
  const double length = norm(s0);
  if (!(length > 0)) return {Vec2{0, 0}, Vec2{norm(s1), 0}, Vec2{-norm(s2), 0}};
  // The cross product of the two shorter sides is the most accurate.
  const double l1 = norm(s1), l2 = norm(s2);
  const double longest = std::max({length, l1, l2});
  const double area = norm(longest == length ? cross(s1, s2) : longest == l1 ? cross(s2, s0) : cross(s0, s1));
  return turned_to_x(length, dot(s1, s0) / length, dot(s2, s0) / length, area / length);
}

FaceLayout layout_of_lengths(double l0, double l1, double l2) {
  if (!(l0 > 0)) return {Vec2{0, 0}, Vec2{l1, 0}, Vec2{-l2, 0}};
  // Kahan's stable form of 16 area^2, sides sorted.
  double x = l0, y = l1, z = l2;
  if (x < y) std::swap(x, y);
  if (y < z) std::swap(y, z);
  if (x < y) std::swap(x, y);
  const double area = 0.5 * std::sqrt(std::max(0.0, (x + (y + z)) * (z - (x - y)) * (z + (x - y)) * (x + (y - z))));
  // a + side 0 = b; c lies at distance l2 from a and l1 from b.
  const double c = 0.5 * (l0 + (l2 - l1) * ((l2 + l1) / l0));
  return turned_to_x(l0, c - l0, -c, area / l0);
}

double relative_height(const Vec2* sides) {
  const double l0 = dot(sides[0], sides[0]), l1 = dot(sides[1], sides[1]), l2 = dot(sides[2], sides[2]);
  const double longest = std::max({l0, l1, l2});
  const double area = longest == l0   ? cross(sides[1], sides[2])
                      : longest == l1 ? cross(sides[2], sides[0])
                                      : cross(sides[0], sides[1]);
  return longest > 0 ? area / longest : 0.0;
}

}  // namespace ahm::trimesh
