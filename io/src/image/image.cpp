#include "ahm/io/image.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/io/atomic_file.hpp"

namespace ahm::io {

Image::Image(int width, int height)
    : width(width), height(height), rgba(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

std::array<double, 4> Image::sample(double u, double v) const {
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

void write_png(const std::filesystem::path& path, const Image& image) {
  AtomicFile file(path);
  file.write(png_bytes(image));
  file.commit();
}

}  // namespace ahm::io
