// The picture while it is drawn: light and nearness of every pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/image.hpp"
#include "bins.hpp"
#include "camera.hpp"
#include "drawable.hpp"
#include "material.hpp"
#include "palette.hpp"

namespace ahm::render {

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

class Layer {
 public:
  /// Triangles that reach behind the camera are cut there.
  Layer(Drawable drawable, const Material& material, const Lens& lens, const Tiles& tiles);

  const Drawable& drawable() const { return drawable_; }
  const Material& material() const { return material_; }
  /// (x, y, nearness) of a mesh's vertex; nearness 0 behind the camera.
  const Eigen::Vector3f& pixel(std::uint32_t vertex) const { return pixels_[vertex]; }
  std::span<const std::uint32_t> in_tile(int tile) const { return bins_[tile]; }

 private:
  bool box_of(std::size_t primitive, const Lens& lens, Box& box) const;

  Drawable drawable_;
  Material material_;
  std::vector<Eigen::Vector3f> pixels_;
  Bins bins_;
};

/// Radius of a disc as it is drawn, at least a sample, at this nearness.
inline float drawn_radius(float radius, float nearness, const Lens& lens) {
  return std::max(radius, 1 / (lens.focal * nearness));
}

}  // namespace ahm::render
