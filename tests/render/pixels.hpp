// Looking at the pixels of a picture.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "patch.hpp"

namespace ahm::render::test {

using Rgb = std::array<int, 3>;

class Pixels {
 public:
  explicit Pixels(Image image) : width(image.width), height(image.height), image_(std::move(image)) {}

  const int width, height;
  Rgb operator()(int x, int y) const {
    const std::uint8_t* p = image_.pixel(x, y);
    return {p[0], p[1], p[2]};
  }
  template <class Predicate>
  int count(const Predicate& predicate) const {
    int result = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) result += predicate((*this)(x, y)) ? 1 : 0;
    return result;
  }
  const Image& image() const { return image_; }

 private:
  Image image_;
};

inline bool is_white(const Rgb& c) { return c == Rgb{255, 255, 255}; }
inline bool is_source_red(const Rgb& c) { return c[0] > 200 && c[1] < 50 && c[2] < 60; }
inline int spread(const Rgb& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }
inline bool is_colored(const Rgb& c) { return spread(c) > 30; }
inline int brightness(const Rgb& c) { return c[0] + c[1] + c[2]; }

/// Pixel of the place (x, y) of a patch, seen from straight above in a picture of 400 x 300: the patch fills the height up
/// to the margin.
inline Rgb at_place(const Pixels& pixels, double x, double y) {
  const double scale = 0.5 * 300 / 1.08;
  return pixels(static_cast<int>(200 + scale * x), static_cast<int>(150 - scale * y));
}

/// Such pictures.
inline PictureOptions from_above() {
  PictureOptions options;
  options.width = 400, options.height = 300;
  options.view_direction = {{0, 0, 1}};
  return options;
}

}  // namespace ahm::render::test
