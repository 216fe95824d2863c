#include "tool_path/ball.hpp"

#include <algorithm>

#include "ahm/util/vec.hpp"

namespace ahm {

Vec3 common_direction(std::span<const Vec3> directions) {
  constexpr int max_steps = 50;
  constexpr double converged = 1e-9;
  Vec3 result = directions.front();
  for (int step = 0; step < max_steps; ++step) {  // Frank and Wolfe's method
    const Vec3 farthest = *std::ranges::min_element(directions, {}, [&](const Vec3& d) { return dot(result, d); });
    const Vec3 change = farthest - result;
    if (-dot(result, change) < converged) break;
    result = result + std::clamp(-dot(result, change) / dot(change, change), 0.0, 1.0) * change;
  }
  return result;
}

std::optional<Vec3> BallPlacer::center(const Vec3& contact, const Vec3& axis, std::span<const Vec3> normals) const {
  const Vec3 upright = contact + radius_ * axis;
  if (fits(upright, part_.nearest_position(upright), radius_)) return upright;
  // A place above the contact. Mean normals can point into the other wall of a groove.
  constexpr double height = 1e-4, least = 1e-3;
  const Vec3 up = common_direction(normals);
  const Vec3 above = contact + height * radius_ * (norm(up) > least ? normalized(up) : axis);
  const std::optional<Vec3> result = along_axis(contact, axis);
  return result && are_connected(*result, above) ? result : std::nullopt;
}

bool BallPlacer::fits(const Vec3& center, const Vec3& nearest, double radius) const {
  return distance(center, nearest) >= (1 - tolerance) * radius;
}

/// A small ball grows along the axis, and moves away from what it would intersect. It can jump through the surface.
std::optional<Vec3> BallPlacer::along_axis(const Vec3& contact, const Vec3& axis) const {
  constexpr int stages = 8, max_moves = 40;
  Vec3 center = contact;
  for (int stage = 1; stage <= stages; ++stage) {
    const double radius = stage * radius_ / stages;
    center = center + (radius_ / stages) * axis;
    for (int move = 0;; ++move) {
      const Vec3 nearest = part_.nearest_position(center);
      if (fits(center, nearest, radius)) break;
      const double away = distance(center, nearest);
      if (move == max_moves || !(away > 0)) return {};
      center = nearest + (radius / away) * (center - nearest);
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
    const double away = distance(at, part_.nearest_position(at));
    if (away < least_step * length) return false;
    share += away / length;
    if (share >= 1) return true;
  }
  return false;
}

}  // namespace ahm
