// What a surface is painted with.
#pragma once

#include "ahm/image.hpp"
#include "ahm/render/picture.hpp"
#include "camera.hpp"
#include "palette.hpp"

namespace ahm::render {

/// A layer's values (`Drawable::values`) as colors.
struct Material {
  enum class Kind {
    pattern,  ///< (u, v, quality)
    texture,  ///< a place on an image
    color,    ///< linear light
  };
  Kind kind = Kind::pattern;
  Pattern pattern = Pattern::polar;
  float sectors = 24;
  float rings = 12;      ///< what the last color of distances stands for
  float pixel_size = 1;  ///< of a pixel, in 1200ths of the picture's height
  const Image* image = nullptr;
  bool transparent = false;  ///< images only: laid over what is behind
};

/// A visible piece of a layer at a place of the picture.
struct Fragment {
  glsl::vec3 value;
  glsl::vec2 dx, dy;  ///< change of the first two values per pixel
  bool known = true;
  glsl::vec3 normal;  ///< camera coordinates, towards the viewer
  glsl::vec2 pixel;
  float opacity = 1;  ///< set by `shade`
};

/// Light that comes from there to the eye.
glsl::vec3 shade(const Material& material, Fragment& fragment);

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

}  // namespace ahm::render
