// What every point is painted by, in the units of the palette.
#pragma once

#include "camera.hpp"

namespace ahm::view {

struct Paint {
  Pattern pattern = Pattern::polar;
  double ring_width = 1;            ///< world units
  double rings = 0;                 ///< up to the largest distance, for distances in colors
  std::vector<Eigen::Vector2d> uv;  ///< per point of the scene, in ring widths; cells: number of the color, distance
  std::vector<float> known;         ///< 1, or 0 where there is nothing to paint by; uv is then 0
  std::vector<float> quality;       ///< 1 where it is not known to be less
};

/// Cells get colors such that the sources of cells of one color lie far apart.
Paint make_paint(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options);

}  // namespace ahm::view
