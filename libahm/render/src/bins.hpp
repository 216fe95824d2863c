// Assignment of primitives to the tiles of the picture.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace ahm::render {

/// A box of samples, half open.
struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;
};

/// Tiles of the picture: squares of samples that are drawn independently.
struct Tiles {
  static constexpr int side = 64;
  int columns, rows;

  Tiles(int width, int height) : columns((width + side - 1) / side), rows((height + side - 1) / side) {}
  int count() const { return columns * rows; }
};

/// The primitives of every tile, ascending: those with a bounding box that overlaps the tile.
class Bins {
 public:
  /// @param box_of  box_of(primitive, Box&) computes the bounding box; false if the primitive is behind the camera
  template <class BoxOf>
  Bins(const Tiles& tiles, std::size_t primitives, const BoxOf& box_of) : begin_(tiles.count() + 1, 0) {
    const auto for_each_tile = [&](std::size_t primitive, const auto& body) {
      Box box;
      if (!box_of(primitive, box)) return;
      const int first = tile(box.left, tiles.columns), last = tile(box.right, tiles.columns);
      if (box.right < 0 || box.bottom < 0 || !(box.left < static_cast<float>(Tiles::side * tiles.columns)) ||
          !(box.top < static_cast<float>(Tiles::side * tiles.rows)))
        return;
      for (int y = tile(box.top, tiles.rows); y <= tile(box.bottom, tiles.rows); ++y)
        for (int x = first; x <= last; ++x) body(y * tiles.columns + x);
    };
    for (std::size_t p = 0; p < primitives; ++p) for_each_tile(p, [&](int t) { ++begin_[t + 1]; });
    for (int t = 0; t < tiles.count(); ++t) begin_[t + 1] += begin_[t];
    primitives_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t p = 0; p < primitives; ++p)
      for_each_tile(p, [&](int t) { primitives_[next[t]++] = static_cast<std::uint32_t>(p); });
  }

  std::span<const std::uint32_t> operator[](int tile) const {
    return std::span(primitives_).subspan(begin_[tile], begin_[tile + 1] - begin_[tile]);
  }

 private:
  static int tile(float sample, int count) {
    return static_cast<int>(std::clamp(sample / Tiles::side, 0.0F, static_cast<float>(count - 1)));
  }

  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> primitives_;
};

}  // namespace ahm::render
