/// \file
/// Images in memory, with transparency. `ahm/io/image.hpp` reads and writes image files.
///
/// \code
/// ahm::Image image(640, 480);                                  // transparent black
/// image.pixel(10, 20)[3] = 255;                                // opaque
/// auto [red, green, blue, opacity] = image.sample(0.5, 0.5);
/// \endcode
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ahm {

/// An image of 8-bit red, green, blue and opacity.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< height x width x 4, top row first; colors are not multiplied by opacity

  Image() = default;
  /// Makes a transparent black image.
  Image(int columns, int rows)
      : width(columns), height(rows), rgba(4 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  std::uint8_t* pixel(int column, int row) {
    return rgba.data() + 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + column);
  }
  const std::uint8_t* pixel(int column, int row) const {
    return rgba.data() + 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + column);
  }

  /// Color and opacity at (u, v), four numbers in [0, 1]. (0, 0) is the lower left corner, (1, 1) the upper right one. Interpolates
  /// bilinearly between pixel centers, with colors weighted by opacity. Points outside get the nearest border color.
  std::array<double, 4> sample(double u, double v) const {
    const double x = std::clamp(u * width - 0.5, 0.0, width - 1.0);
    const double y = std::clamp((1 - v) * height - 0.5, 0.0, height - 1.0);
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    std::array<double, 4> sum{};
    for (int below : {0, 1})
      for (int right : {0, 1}) {
        const double weight = (right ? x - column : 1 - (x - column)) * (below ? y - row : 1 - (y - row));
        if (weight == 0) continue;
        const std::uint8_t* p = pixel(column + right, row + below);
        const double alpha = weight * p[3] / 255;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * p[c] / 255;
        sum[3] += alpha;
      }
    for (std::size_t c = 0; c < 3 && sum[3] > 0; ++c) sum[c] /= sum[3];
    return sum;
  }
};

}  // namespace ahm
