/// \file
/// Curves in the plane of coordinates.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "ahm/applications/stroke.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// Position and unit direction of a curve at one of its points, in the plane of coordinates.
struct PlanePoint {
  Vec2 position, direction;
};

/// The place at arclength s of a curve of this length.
inline PlanePoint place_in_plane(double s, double length, StrokeShape shape) {
  if (shape == StrokeShape::line) return {{s, 0}, {1, 0}};
  const double radius = length / (2 * std::numbers::pi), c = std::cos(s / radius), d = std::sin(s / radius);
  return {{radius * c, radius * d}, {-d, c}};
}

/// @throws InvalidArgument (`circle` on an open curve)
void check_shape(const StrokeOptions& options);

/// Unit directions of a curve in the plane at each of its points.
/// @throws InvalidArgument (number of positions other than `points`, a position that is not finite, a curve that turns back
/// or does not advance)
std::vector<Vec2> directions_of(std::span<const Vec2> positions, std::size_t points, bool closed);

}  // namespace ahm
