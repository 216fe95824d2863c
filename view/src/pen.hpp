// The few flat shapes drawn on a picture.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "ahm/image.hpp"

namespace ahm::view {

using Color = std::array<std::uint8_t, 3>;  // sRGB

/// Draws on an opaque image. Positions in pixels, x right, y down, pixel centers at .5.
class Pen {
 public:
  explicit Pen(Image& image) : image_(image) {}

  using ColorAt = std::function<Color(const Eigen::Vector2d&)>;  ///< of a place on the image

  void disc(const Eigen::Vector2d& center, double radius, Color color);
  void disc(const Eigen::Vector2d& center, double radius, const ColorAt& color);
  void box(Eigen::Vector2d low, Eigen::Vector2d high, const ColorAt& color);
  /// A line with round ends.
  void line(Eigen::Vector2d from, Eigen::Vector2d to, double width, Color color);
  void triangle(Eigen::Vector2d a, Eigen::Vector2d b, Eigen::Vector2d c, double rounding, Color color);
  /// Digits, sign, point, e, u and v; returns the width. `at` is the left end of the base line.
  double text(Eigen::Vector2d at, double height, double stroke, std::string_view text, Color color);

 private:
  template <class PaintAt, class Distance>
  void fill(Eigen::Vector2d low, Eigen::Vector2d high, const PaintAt& color, const Distance& distance);

  Image& image_;
};

}  // namespace ahm::view
