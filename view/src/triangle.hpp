// A triangle in one tile: where it is, how near, and what its corners carry.
#pragma once

#include "layer.hpp"

namespace ahm::view {

/// Coordinates are samples from the tile's corner.
struct TileTriangle {
  const Layer* layer;
  std::array<std::uint32_t, 3> corner;
  std::array<float, 3> nearness;  ///< of the corners
  std::array<float, 3> a, b, c;   ///< of corner k: a x + b y + c, positive inside, zero on the opposite side
  float near_x, near_y, near_0;   ///< nearness: near_x x + near_y y + near_0
  float left, top, right, bottom;

  /// False for a triangle without area.
  bool set(const Layer& from, std::uint32_t triangle, float tile_x, float tile_y);
  /// Interpolated with perspective.
  Fragment at(float x, float y, const Lens& lens) const;

 private:
  std::array<float, 3> weights(float x, float y) const;
  glsl::vec3 value(const std::array<float, 3>& weight) const;
};

}  // namespace ahm::view
