#include "film.hpp"

#include <array>

#include "ahm/util/parallel.hpp"

namespace ahm::view {
namespace {

struct Step {
  int x, y;
  float length;
};

/// Eight places around, this many pixels away.
std::array<Step, 8> circle(float radius, float turn) {
  std::array<Step, 8> steps;
  for (std::size_t k = 0; k < 8; ++k) {
    const float angle = 0.785398F * (static_cast<float>(k) + turn);
    steps[k] = {static_cast<int>(std::lround(radius * std::cos(angle))),
                static_cast<int>(std::lround(radius * std::sin(angle))), radius};
  }
  return steps;
}

/// How much light is left in crevices (Boucheny's eye-dome lighting), seen at two radii.
class Crevices {
 public:
  Crevices(const Film& film, float focal)
      : film_(film), focal_(focal), fine_(circle(detail(), 0)), coarse_(circle(3 * detail(), 0.5F)) {}

  float light(int x, int y) const {
    const float nearness = film_.at(x, y).nearness;
    if (!(nearness > 0)) return 1;
    float sum = 0;
    for (const auto* steps : {&fine_, &coarse_})
      for (const Step& step : *steps) {
        const int column = std::clamp(x + step.x, 0, film_.width - 1),
                  row = std::clamp(y + step.y, 0, film_.height - 1);
        const float other = film_.at(column, row).nearness;
        // (depth - other depth) in pixels at this depth, per pixel of distance
        if (other > nearness) sum += std::clamp((1 - nearness / other) * focal_ / step.length - 1, 0.0F, 4.0F);
      }
    return sum > 0 ? std::exp(-0.05F * sum) : 1;
  }

 private:
  float detail() const { return std::max(1.0F, static_cast<float>(film_.height) / 800); }

  const Film& film_;
  float focal_;
  std::array<Step, 8> fine_, coarse_;
};

}  // namespace

void fill_pinholes(Film& film, float gap, unsigned threads) {
  const std::array<Step, 8> steps = circle(1.5F, 0);
  std::vector<std::pair<std::size_t, Pixel>> filled;
  std::mutex mutex;
  detail::parallel_chunks(film.height, 16, threads, [&](Offset begin, Offset end) {
    std::vector<std::pair<std::size_t, Pixel>> found;
    for (int y = static_cast<int>(begin); y < end; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Pixel& here = film.at(x, y);
        int nearer = 0;
        const Pixel* other = nullptr;
        for (const Step& step : steps) {
          if (x + step.x < 0 || x + step.x >= film.width || y + step.y < 0 || y + step.y >= film.height) continue;
          const Pixel& around = film.at(x + step.x, y + step.y);
          if (around.cover < 65535) continue;
          if (here.nearness > 0 && 1 / here.nearness - 1 / around.nearness < gap && here.cover == 65535) continue;
          ++nearer;
          other = &around;
        }
        if (nearer >= 7) found.emplace_back(&here - film.pixels.data(), *other);
      }
    std::scoped_lock lock(mutex);
    filled.insert(filled.end(), found.begin(), found.end());
  });
  for (const auto& [place, pixel] : filled) film.pixels[place] = pixel;  // each place once: any order
}

Image develop(const Film& film, float focal, bool darken, unsigned threads) {
  Image image(film.width, film.height);
  const Crevices crevices(film, focal);
  detail::parallel_chunks(film.height, 16, threads, [&](Offset begin, Offset end) {
    for (int y = static_cast<int>(begin); y < end; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Pixel& pixel = film.at(x, y);
        std::uint8_t* out = image.pixel(x, y);
        const float left = darken ? crevices.light(x, y) : 1;
        for (std::size_t c = 0; c < 3; ++c)
          out[c] = glsl::to_srgb_byte(
              static_cast<std::uint16_t>(std::lround(left * static_cast<float>(pixel.light[c])) + 65535 - pixel.cover));
        out[3] = 255;
      }
  });
  return image;
}

}  // namespace ahm::view
