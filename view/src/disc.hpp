// A point of a cloud in one tile: a tilted disc whose values change along it.
#pragma once

#include "layer.hpp"

namespace ahm::view {

/// Coordinates are samples from the tile's corner; i, j samples from the disc's center. The disc is taken as seen from
/// straight ahead, which it is small enough for.
struct TileDisc {
  const Layer* layer;
  float x, y;
  float t_ii, t_ij, t_jj;  ///< t(i, j): squared distance from the center, 1 at the rim
  float half_width, half_height;
  float nearness, near_i, near_j;  ///< linear in i, j
  float thickness;                 ///< in nearness: discs within it of the nearest one are blended
  glsl::vec3 value;
  glsl::vec2 value_i, value_j;  ///< change of the first two values per sample
  float tolerance;              ///< discs of values closer than this are blended
  bool known;
  float normal_x, normal_y;

  /// False behind the camera.
  bool set(const Layer& from, std::uint32_t point, const Lens& lens, float tile_x, float tile_y);
};

}  // namespace ahm::view
