/// \file
/// A one-sided surface that is flat everywhere.
#pragma once

#include <array>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

/// A jittered strip of paper 1 long and 0.2 wide, its ends glued with a twist: flat, one-sided, and known by its edge
/// lengths.
struct PaperBand {
  Index around = 0, across = 0;  ///< quads
  std::vector<Triangle> faces;
  std::vector<std::array<double, 3>> lengths;
  /// Positions of corner s of face f in the strip, without wrapping round: 3 per face.
  std::vector<Vec2> corners;
  std::vector<Vec2> plane;  ///< per vertex

  /// Distance in the strip, through the glued ends where that is shorter.
  double distance(const Vec2& p, const Vec2& q) const;
};
PaperBand paper_band(Index around, Index across, unsigned seed = 1);

}  // namespace ahm::test
