// The three-dimensional part of a PNG.
#pragma once

#include "drawable.hpp"
#include "image.hpp"

namespace ahm::view {

/// The polar checkerboard by itself, in a corner.
struct Legend {
  double x = 0, y = 0, radius = 0;  ///< pixels, y down; no legend if the radius is 0
  double rings = 2;
};

/// The drawable, shaded and painted, without marks. @throws Error if OpenGL fails.
Image render(const Drawable& drawable, const Camera& camera, double ring_width, const PictureOptions& options,
             const Legend& legend);

}  // namespace ahm::view
