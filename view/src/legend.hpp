// What the colors mean, in the lower left corner.
#pragma once

#include "material.hpp"
#include "pen.hpp"

namespace ahm::view {

/// The pattern as a wheel with its axes and the width of a ring, or the colors of distances as a bar with numbers;
/// nothing for cells, for the surface alone, and on pictures too small to read it.
void draw_legend(Image& image, const Material& material, double ring_width);

}  // namespace ahm::view
