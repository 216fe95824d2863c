// The picture while it is drawn: light and nearness of every pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/image.hpp"
#include "lens.hpp"
#include "palette.hpp"

namespace ahm::view {

/// Light in 65535ths, that of the background left out.
struct Pixel {
  std::array<std::uint16_t, 3> light{};
  std::uint16_t cover = 0;  ///< how much of the pixel is not background
  float nearness = 0;       ///< of the nearest thing in it
};

struct Film {
  int width, height;
  std::vector<Pixel> pixels;

  Film(int columns, int rows)
      : width(columns), height(rows), pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  Pixel& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x]; }
  const Pixel& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x];
  }
};

/// Fills single pixels that chance left open between points: all around, something is nearer by more than `gap`.
void fill_pinholes(Film& film, float gap, unsigned threads);

/// The picture on white. `focal` in pixels.
/// @param darken  what lies behind its surroundings
Image develop(const Film& film, float focal, bool darken, unsigned threads);

}  // namespace ahm::view
