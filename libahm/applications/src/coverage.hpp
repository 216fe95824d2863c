/// \file
/// Where a curve goes in the plane of coordinates.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "ahm/applications/stroke.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// Where a point of the curve lies in the plane of coordinates, and which way the curve runs there, unit length.
struct PlanePlace {
  Vec2 position, direction;
};

/// At arclength s of a curve of this length.
inline PlanePlace place_in_plane(double s, double length, StrokeShape shape) {
  if (shape == StrokeShape::line) return {{s, 0}, {1, 0}};
  const double radius = length / (2 * std::numbers::pi), c = std::cos(s / radius), d = std::sin(s / radius);
  return {{radius * c, radius * d}, {-d, c}};
}

/// @throws InvalidArgument (`circle` on an open curve)
void check_shape(const StrokeOptions& options);

/// Which way a curve runs in the plane at each of its points.
/// @throws InvalidArgument (as many positions as points, finite ones; a curve that turns back or stands still)
std::vector<Vec2> directions_of(std::span<const Vec2> positions, std::size_t points, bool closed);

}  // namespace ahm
