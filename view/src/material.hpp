// What a surface is painted with.
#pragma once

#include "ahm/image.hpp"
#include "ahm/view/picture.hpp"
#include "palette.hpp"

namespace ahm::view {

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

}  // namespace ahm::view
