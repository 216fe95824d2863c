#include "tool_path/ball.hpp"

#include <algorithm>

#include "ahm/util/vec.hpp"

namespace ahm {

Vec3 turned_away(std::span<const Vec3> normals, Vec3 axis) {
  constexpr double least = 0.1;
  constexpr int max_steps = 20;
  for (int step = 0; step < max_steps; ++step) {
    const Vec3 normal = *std::ranges::min_element(normals, {}, [&](const Vec3& n) { return dot(axis, n); });
    const double height = dot(axis, normal);
    if (height >= least) break;
    const Vec3 turned = axis + (1.01 * least - height) * normal;
    if (norm(turned) < least) break;
    axis = normalized(turned);
  }
  return axis;
}

std::optional<Vec3> BallPlacer::center(const Vec3& contact, const Vec3& direction) const {
  const Vec3 upright = contact + radius_ * direction;
  if (!cut(upright, radius_)) return upright;
  constexpr double height = 1e-4;
  const std::optional<Vec3> result = grown(contact, direction);
  return result && are_connected(*result, contact + height * radius_ * direction) ? result : std::nullopt;
}

/// The point of the surface that is deepest in a ball; none: the ball fits.
std::optional<Vec3> BallPlacer::cut(const Vec3& center, double radius) const {
  return part_.nearest_position(center, (1 - tolerance) * radius);
}

/// A small ball grows in a direction, and moves away from what it would intersect. It can jump through the surface. The same sizes
/// everywhere keep the path continuous.
std::optional<Vec3> BallPlacer::grown(const Vec3& contact, const Vec3& direction) const {
  constexpr double first = 1.0 / 64,
                   growth = 1.5;  // where a ball fits, the next one moves by less than the width of a groove
  constexpr int max_moves = 100;
  double radius = 0;
  Vec3 center = contact;
  while (radius < radius_) {
    const double next = std::min(radius_, std::max(first * radius_, growth * radius));
    center = center + (next - radius) * direction;
    radius = next;
    for (int move = 0;; ++move) {
      const std::optional<Vec3> nearest = cut(center, radius);
      if (!nearest) break;
      const double away = distance(center, *nearest);
      if (move == max_moves || !(away > 0)) return {};
      center = *nearest + (radius / away) * (center - *nearest);
    }
  }
  return center;
}

/// Whether the segment between two positions does not cross the surface. From every point, the distance from the surface is a step
/// that cannot cross it.
bool BallPlacer::are_connected(const Vec3& from, const Vec3& to) const {
  constexpr int max_steps = 200;
  constexpr double least_step = 1e-6;
  const double length = distance(from, to);
  double share = 0;
  for (int step = 0; step < max_steps; ++step) {
    const Vec3 at = (1 - share) * from + share * to;
    const std::optional<Vec3> nearest = part_.nearest_position(at, (1 - share) * length);
    if (!nearest) return true;
    const double away = distance(at, *nearest);
    if (away < least_step * length) return false;
    share += away / length;
  }
  return false;
}

}  // namespace ahm
