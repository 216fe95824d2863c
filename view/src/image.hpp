// A picture in memory and the few flat shapes drawn on it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace ahm::view {

using Colour = std::array<std::uint8_t, 3>;  // sRGB

/// Rows from top to bottom, three bytes per pixel. Positions in pixels, x right, y down, pixel centres at .5.
class Image {
 public:
  Image(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  const std::uint8_t* data() const { return pixels_.data(); }
  std::uint8_t* pixel(int x, int y) {
    return &pixels_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x))];
  }

  void disc(Eigen::Vector2d centre, double radius, Colour colour);
  /// A line with round ends.
  void line(Eigen::Vector2d from, Eigen::Vector2d to, double width, Colour colour);
  void triangle(Eigen::Vector2d a, Eigen::Vector2d b, Eigen::Vector2d c, double rounding, Colour colour);
  /// Digits, sign, point, e, u and v; returns the width. `at` is the left end of the base line.
  double text(Eigen::Vector2d at, double height, double stroke, std::string_view text, Colour colour);

 private:
  template <class Distance>
  void fill(Eigen::Vector2d low, Eigen::Vector2d high, Colour colour, const Distance& distance);

  int width_, height_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace ahm::view
