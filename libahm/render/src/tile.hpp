// Discs and triangles in a tile of the picture, and the renderer of a tile.
#pragma once

#include "film.hpp"

namespace ahm::render {

/// A point of a cloud in a tile: a tilted disc with linear values. x and y are samples from the tile's corner; i and j are samples from
/// the disc's center. The projection of a disc is orthographic, which is accurate for small discs.
struct TileDisc {
  const Layer* layer;
  float x, y;
  float t_ii, t_ij, t_jj;  ///< t(i, j): squared distance from the center, 1 at the rim
  float half_width, half_height;
  float nearness, near_i, near_j;  ///< the nearness, a linear function of i and j
  float thickness;                 ///< in nearness: discs this close to the nearest one are blended with it
  glsl::vec3 value;
  glsl::vec2 value_i, value_j;  ///< change of the first two values per sample
  float tolerance;              ///< discs with values closer than this are blended
  bool known;
  float normal_x, normal_y;

  /// @return false if the disc is behind the near plane
  bool set(const Layer& from, std::uint32_t point, const Lens& lens, float tile_x, float tile_y);
};

/// A triangle in a tile. Coordinates are samples from the tile's corner.
struct TileTriangle {
  const Layer* layer;
  std::array<std::uint32_t, 3> corner;
  std::array<float, 3> nearness;  ///< nearness of the corners
  std::array<float, 3> a, b, c;   ///< a[k] x + b[k] y + c[k] is positive inside and zero on the side opposite corner k
  float near_x, near_y, near_0;   ///< the nearness is near_x x + near_y y + near_0
  float left, top, right, bottom;

  /// @return false for a triangle without area
  bool set(const Layer& from, std::uint32_t triangle, float tile_x, float tile_y);
  /// The fragment at a position, interpolated with perspective correction.
  Fragment at(float x, float y, const Lens& lens) const;

 private:
  std::array<float, 3> weights(float x, float y) const;
  glsl::vec3 value(const std::array<float, 3>& weight) const;
};

/// Draws tiles. Reuses its buffers.
class TileRenderer {
 public:
  static constexpr int factor = 2;  ///< samples per pixel in each direction

  TileRenderer(const std::vector<Layer>& layers, const Lens& lens, const Tiles& tiles);
  /// Draws a tile on the film. The result does not depend on tiles drawn before.
  void draw(int tile, Film& film);

 private:
  static constexpr int side = Tiles::side, samples = side * side;
  static constexpr std::uint32_t nothing = 0xffffffff, disc_bit = 0x80000000;

  /// Weighted sums over the discs at a sample.
  struct Sums {
    std::array<float, samples> weight, nearness, normal_x, normal_y;  ///< sums over all discs in the front layer
    std::array<float, samples> known, first, second, third;           ///< sums over the discs with similar values
    std::array<float, samples> front_first, front_second;             ///< values of the nearest disc
  };

  /// Center of a sample, in samples from the tile's corner.
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
  /// The blended fragment of the discs at a sample.
  Fragment fragment(int sample) const;
  const Material& material(std::uint32_t id) const;
  glsl::vec3 light(int sample, glsl::vec2 pixel) const;
  void shade_pixel(int x, int y);
  void lay_over(const TileTriangle& triangle);
  void develop(Film& film) const;

  const std::vector<Layer>& layers_;
  const Lens& lens_;
  Tiles tiles_;
  float left_ = 0, top_ = 0;  ///< position of the tile, samples
  std::vector<TileTriangle> triangles_, transparent_;
  std::vector<TileDisc> discs_;
  std::array<float, samples> nearness_;
  std::array<std::uint32_t, samples> front_;
  std::array<float, samples / 64> block_;  ///< nearness of the farthest sample of each block of 8 x 8
  std::array<glsl::vec3, samples> light_;
  std::array<bool, samples> covered_;
  Sums sums_;
};

}  // namespace ahm::render
