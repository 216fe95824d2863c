#include "read/colors.hpp"

#include <algorithm>
#include <cmath>

namespace ahm::io {

std::optional<std::vector<Color>> to_colors(const std::vector<Vec3>& values, bool deep) {
  double largest = 0;
  bool positive = true, whole = true;
  for (const Vec3& color : values)
    for (const double x : color) {
      positive = positive && x >= 0;
      whole = whole && x == std::floor(x);
      largest = std::max(largest, x);
    }
  const bool fractions = largest <= 1;
  if (!positive || !(fractions || whole) || largest > (deep ? 65535 : 255)) return std::nullopt;
  const double scale = fractions ? 255 : largest <= 255 ? 1 : 255.0 / 65535;
  std::vector<Color> colors(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) colors[i][c] = static_cast<std::uint8_t>(std::lround(scale * values[i][c]));
  return colors;
}

}  // namespace ahm::io
