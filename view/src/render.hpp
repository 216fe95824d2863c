// The three-dimensional part of a PNG.
#pragma once

#include "ahm/image.hpp"
#include "drawable.hpp"

namespace ahm::view {

/// The pattern by itself, in a corner.
struct Legend {
  double x = 0, y = 0, radius = 0;  ///< pixels, y down; no legend if the radius is 0
  double rings = 2;
};

/// A picture without marks, and how far away what it shows is.
struct Rendering {
  Image image;
  int factor;                 ///< samples of depth per pixel and side
  std::vector<float> depths;  ///< along the camera's axis in scene units, infinite for the background; rows upwards

  /// Whether a position in camera coordinates is in the picture with nothing before it, up to a tolerance.
  bool shows(const Camera& camera, const Eigen::Vector3d& position, double tolerance) const;
};

/// The drawable, shaded and painted. @throws Error if OpenGL fails.
Rendering render(const Drawable& drawable, const Camera& camera, double ring_width, const PictureOptions& options,
                 const Legend& legend);

}  // namespace ahm::view
