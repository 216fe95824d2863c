// The picture during rendering: color and nearness of every pixel.
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

/// A pixel; linear color in 65535ths, without the background.
struct Pixel {
  std::array<std::uint16_t, 3> light{};
  std::uint16_t coverage = 0;  ///< covered part of the pixel, in 65535ths
  float nearness = 0;          ///< nearness of the nearest object in the pixel
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

/// Fills single pixels that are gaps between discs: at least seven of eight surrounding pixels are nearer by more than `gap`.
void fill_pinholes(Film& film, float gap, unsigned threads);

/// Converts the film to an image on a white background.
/// @param focal   focal length, pixels
/// @param darken  darkens pixels that are behind their surroundings
Image develop(const Film& film, float focal, bool darken, unsigned threads);

/// An object that is drawn, with its projection and its primitives by tile.
class Layer {
 public:
  /// Clips triangles at the near plane.
  Layer(Drawable drawable, const Material& material, const Lens& lens, const Tiles& tiles);

  const Drawable& drawable() const { return drawable_; }
  const Material& material() const { return material_; }
  /// (x, y, nearness) of a vertex of a mesh; the nearness is 0 behind the camera.
  const Eigen::Vector3f& pixel(std::uint32_t vertex) const { return pixels_[vertex]; }
  std::span<const std::uint32_t> in_tile(int tile) const { return bins_[tile]; }

 private:
  bool box_of(std::size_t primitive, const Lens& lens, Box& box) const;

  Drawable drawable_;
  Material material_;
  std::vector<Eigen::Vector3f> pixels_;
  Bins bins_;
};

/// Radius of a disc when drawn at this nearness: at least one sample.
inline float drawn_radius(float radius, float nearness, const Lens& lens) {
  return std::max(radius, 1 / (lens.focal * nearness));
}

}  // namespace ahm::render
