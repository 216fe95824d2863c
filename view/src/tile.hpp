// One square of the picture: what is nearest at every sample, its color, and the pixels they make.
#pragma once

#include "disc.hpp"
#include "film.hpp"
#include "triangle.hpp"

namespace ahm::view {

/// Draws one tile after the other; the buffers are kept.
class TileRenderer {
 public:
  static constexpr int factor = 2;  ///< samples per pixel and direction

  TileRenderer(const std::vector<Layer>& layers, const Lens& lens, const Tiles& tiles);
  /// Fills the tile's pixels. What it draws depends on the tile alone.
  void draw(int tile, Film& film);

 private:
  static constexpr int side = Tiles::side, samples = side * side;
  static constexpr std::uint32_t nothing = 0xffffffff, disc_bit = 0x80000000;

  /// Weighted sums over the discs at a sample.
  struct Sums {
    std::array<float, samples> weight, nearness, normal_x, normal_y;  ///< of all in the front layer
    std::array<float, samples> known, first, second, third;           ///< of those whose values agree
    std::array<float, samples> front_first, front_second;             ///< the nearest disc's values
  };

  /// Of a sample, in samples from the tile's corner.
  static glsl::vec2 middle_of(int sample) {
    const int column = sample % side, row = sample / side;
    return {static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F};
  }

  void collect(int tile);
  void find_nearest(const TileTriangle& triangle, std::uint32_t id);
  void find_nearest(const TileDisc& disc, std::uint32_t id);
  void find_blocks();
  bool is_hidden(const TileDisc& disc) const;
  void start_sums();
  void add(const TileDisc& disc);
  /// What the samples show.
  Fragment fragment(int sample) const;
  const Material& material(std::uint32_t id) const;
  glsl::vec3 light(int sample, glsl::vec2 pixel) const;
  void shade_pixel(int x, int y);
  void lay_over(const TileTriangle& triangle);
  void develop(Film& film) const;

  const std::vector<Layer>& layers_;
  const Lens& lens_;
  Tiles tiles_;
  float left_ = 0, top_ = 0;  ///< of the tile, in samples
  std::vector<TileTriangle> triangles_, transparent_;
  std::vector<TileDisc> discs_;
  std::array<float, samples> nearness_;
  std::array<std::uint32_t, samples> front_;
  std::array<float, samples / 64> block_;  ///< nearness of the farthest sample of 8 x 8
  std::array<glsl::vec3, samples> light_;
  std::array<bool, samples> covered_;
  Sums sums_;
};

}  // namespace ahm::view
