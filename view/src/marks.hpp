// What is drawn on the finished picture: source, axes, curve, dots.
#pragma once

#include "film.hpp"
#include "pen.hpp"

namespace ahm::view {

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

}  // namespace ahm::view
