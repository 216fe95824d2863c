/// \file
/// The charts of an atlas in one square texture.
///
/// \code
/// ahm::TextureAtlas packed = ahm::pack(atlas, faces, {.size = 2048, .margin = 4});
/// ahm::Image image = ahm::checkerboard(packed);         // something to look at; packed.coordinates are the uv
/// \endcode
#pragma once

#include <array>
#include <vector>

#include "ahm/applications/atlas.hpp"
#include "ahm/image.hpp"

namespace ahm {

struct PackOptions {
  int size = 2048;  ///< texels of a side of the square; 16 to 32768
  int margin = 4;   ///< texels kept free around each chart, and at the border of the square; >= 0
};

/// Where a chart lies, in texels from the lower left corner of the square, its margin not included.
struct TextureBox {
  int x, y, width, height;
};

struct TextureAtlas {
  int size = 0, margin = 0;
  double scale = 0;                 ///< texels per world unit, the same for all charts
  double filled = 0;                ///< share of the square that the boxes of the charts take
  std::vector<TextureBox> boxes;    ///< one per chart; they do not touch, nor do their margins overlap
  std::vector<double> coordinates;  ///< corners x 2 in [0, 1], (0, 0) the lower left corner; NaN without a chart
};

/// Whether this build can pack (needs stb).
bool can_pack() noexcept;

/// Turns every chart into its rectangle of least area and packs the rectangles as large as they fit (stb_rect_pack),
/// all lying or all standing, at one scale.
/// @throws InvalidArgument (options; no room for so many charts), Error (built without stb)
TextureAtlas pack(const Atlas& atlas, const FaceList& faces, const PackOptions& options = {});

/// Squares of equal size in every chart, along its box, in a hue of its own; margins are painted like their chart.
/// @param square  side in texels; 0: 64 along the side of the texture
Image checkerboard(const TextureAtlas& atlas, int square = 0);

}  // namespace ahm
