// Flat shapes that are drawn on a picture: legend and marks.
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

/// Draws on an opaque image. Positions are in pixels: x to the right, y down, pixel centers at 0.5.
class Pen {
 public:
  explicit Pen(Image& image) : image_(image) {}

  using ColorAt = std::function<Color(const Eigen::Vector2d&)>;  ///< color at a position

  void disc(const Eigen::Vector2d& center, double radius, Color color);
  void disc(const Eigen::Vector2d& center, double radius, const ColorAt& color);
  void box(Eigen::Vector2d low, Eigen::Vector2d high, const ColorAt& color);
  /// A line with round ends.
  void line(Eigen::Vector2d from, Eigen::Vector2d to, double width, Color color);
  void triangle(Eigen::Vector2d a, Eigen::Vector2d b, Eigen::Vector2d c, double rounding, Color color);
  /// Draws digits, signs, points, and the letters e, u and v. @param at  left end of the baseline @return the width
  double text(Eigen::Vector2d at, double height, double stroke, std::string_view text, Color color);

 private:
  template <class PaintAt, class Distance>
  void fill(Eigen::Vector2d low, Eigen::Vector2d high, const PaintAt& color, const Distance& distance);

  Image& image_;
};

/// Draws the legend: a wheel with the pattern, its axes and the ring width, or a color bar of the distances. Draws nothing for cells, for
/// surfaces without a map, and on pictures that are too small.
void draw_legend(Image& image, const Material& material, double ring_width);

constexpr Color white = {255, 255, 255}, ink = {25, 25, 30}, red = {225, 20, 30};

struct Arrow {
  Eigen::Vector2d from, to;
  double width;
};

/// Draws arrows, dark with a white outline, to be visible on any color. @param unit  a 1200th of the picture's smaller side
void draw_arrows(Pen& pen, const std::vector<Arrow>& arrows, double unit);
void draw_text(Pen& pen, const Eigen::Vector2d& at, double height, double unit, std::string_view text);

/// Draws the visible parts of the curve, the dots, the source and its axes.
/// @param spacing  typical distance between vertices, scene units; sets the tolerance of the depth test
void draw_marks(Image& image, const Film& film, const Scene& scene, const Camera& camera, double spacing);

}  // namespace ahm::render
