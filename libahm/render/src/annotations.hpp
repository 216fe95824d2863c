// The few flat shapes drawn on a picture.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "ahm/image.hpp"
#include "film.hpp"
#include "material.hpp"

namespace ahm::render {

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

/// The pattern as a wheel with its axes and the width of a ring, or the colors of distances as a bar with numbers;
/// nothing for cells, for the surface alone, and on pictures too small to read it.
void draw_legend(Image& image, const Material& material, double ring_width);

constexpr Color white = {255, 255, 255}, ink = {25, 25, 30}, red = {225, 20, 30};

struct Arrow {
  Eigen::Vector2d from, to;
  double width;
};

/// In ink, on a rim of white: visible on any color. `unit` is a 1200th of the picture's smaller side.
void draw_arrows(Pen& pen, const std::vector<Arrow>& arrows, double unit);
void draw_text(Pen& pen, const Eigen::Vector2d& at, double height, double unit, std::string_view text);

/// Curve, dots, source and axes, as far as nothing on the film stands before them.
/// @param spacing  typical distance between vertices, in scene units: how well the film knows where the surface is
void draw_marks(Image& image, const Film& film, const Scene& scene, const Camera& camera, double spacing);

}  // namespace ahm::render
