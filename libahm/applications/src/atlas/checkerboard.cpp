#include <algorithm>
#include <cmath>

#include "ahm/applications/atlas.hpp"

namespace ahm {

Image checkerboard(const TextureAtlas& atlas, int square) {
  if (square <= 0) square = std::max(1, atlas.size / 64);
  Image image(atlas.size, atlas.size);
  for (std::size_t k = 0; k < image.rgba.size(); k += 4)
    std::fill_n(image.rgba.begin() + static_cast<Offset>(k), 4, 255);
  for (std::size_t k = 0; k < atlas.boxes.size(); ++k) {
    // Hues a golden angle apart; light and dark squares.
    std::array<std::array<std::uint8_t, 3>, 2> color;
    for (std::size_t c = 0; c < 3; ++c) {
      const double hue = 2.39996322972865 * static_cast<double>(k) - 2.0943951023932 * static_cast<double>(c);
      const double wave = 0.5 + 0.5 * std::cos(hue);
      color[0][c] = static_cast<std::uint8_t>(std::lround(255 * (0.62 + 0.38 * wave)));
      color[1][c] = static_cast<std::uint8_t>(std::lround(255 * (0.12 + 0.6 * wave)));
    }
    const TextureBox& box = atlas.boxes[k];
    const int reach = atlas.margin / 2;
    for (int y = std::max(0, box.y - reach); y < std::min(atlas.size, box.y + box.height + reach); ++y)
      for (int x = std::max(0, box.x - reach); x < std::min(atlas.size, box.x + box.width + reach); ++x) {
        const int column = (x - box.x + 64 * square) / square, row = (y - box.y + 64 * square) / square;
        std::copy_n(color[(column + row) % 2].begin(), 3, image.pixel(x, atlas.size - 1 - y));
      }
  }
  return image;
}

}  // namespace ahm
