// Materials: how the values of a surface become colors.
#pragma once

#include "ahm/image.hpp"
#include "ahm/render/picture.hpp"
#include "camera.hpp"
#include "palette.hpp"

namespace ahm::render {

/// Conversion of a layer's values (`Drawable::values`) to colors.
struct Material {
  enum class Kind {
    pattern,  ///< the values are (u, v, quality)
    texture,  ///< the values are texture coordinates
    color,    ///< the values are a linear color
  };
  Kind kind = Kind::pattern;
  Pattern pattern = Pattern::polar;
  float sectors = 24;
  float rings = 12;      ///< distance at the end of the color scale, in rings
  float pixel_size = 1;  ///< size of a pixel, in 1200ths of the picture's smaller side
  const Image* image = nullptr;
  bool transparent = false;  ///< textures only: drawn over objects behind
};

/// The visible part of a layer at a sample.
struct Fragment {
  glsl::vec3 value;
  glsl::vec2 dx, dy;  ///< change of the first two values per pixel
  bool known = true;
  glsl::vec3 normal;  ///< in camera coordinates, towards the viewer
  glsl::vec2 pixel;
  float opacity = 1;  ///< set by `shade`
};

/// The color of a fragment with lighting, linear. Sets its opacity.
glsl::vec3 shade(const Material& material, Fragment& fragment);

/// Value of `Paint::quality` where the distance is only a lower bound.
constexpr float bounded_mark = 2;

struct Paint {
  Pattern pattern = Pattern::polar;
  double ring_width = 1;            ///< world units
  double rings = 0;                 ///< number of rings up to the largest distance; only for Pattern::distance
  std::vector<Eigen::Vector2d> uv;  ///< per point of the scene, in ring widths; for cells: color, distance
  std::vector<float> known;         ///< 1, or 0 for points without a value, with uv = 0
  std::vector<float>
      quality;  ///< quality; 1 if unknown; `bounded_mark` where it is not low and the distance is only a bound
};

/// Computes the values that determine the colors. Cells of the same color are far apart.
Paint make_paint(const Scene& scene, const std::vector<Index>& shown, const PictureOptions& options);

}  // namespace ahm::render
