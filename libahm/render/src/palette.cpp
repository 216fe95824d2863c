#include "palette.hpp"

#include <array>

#include "ahm/util/srgb.hpp"

namespace ahm::render::glsl {

// Included, because the browser uses the same file.
#include "palette.glsl"

float from_srgb(float tone) { return detail::light_of(tone); }

std::uint8_t to_srgb_byte(std::uint16_t light) {
  static const auto tones = [] {
    std::array<std::uint8_t, 65536> table;
    for (std::size_t k = 0; k < table.size(); ++k) {
      const double x = static_cast<double>(k) / 65535;
      const double tone = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      table[k] = static_cast<std::uint8_t>(std::lround(255 * tone));
    }
    return table;
  }();
  return tones[light];
}

}  // namespace ahm::render::glsl
