/// \file
/// A one-sided surface that is flat everywhere.
#pragma once

#include <array>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::test {

/// A jittered paper strip of length 1 and width 0.2, with its ends glued after a twist: flat and one-sided, described by
/// edge lengths.
struct PaperBand {
  Index around = 0, across = 0;  ///< numbers of quads
  std::vector<Triangle> faces;
  std::vector<std::array<double, 3>> lengths;
  /// Positions of the corners in the strip, 3 per face. A face at the glued ends is not wrapped around.
  std::vector<Vec2> corners;
  std::vector<Vec2> plane;  ///< position of each vertex in the strip

  /// Distance in the strip, or across the glued ends where that is shorter.
  double distance(const Vec2& p, const Vec2& q) const;
};
PaperBand paper_band(Index around, Index across, unsigned seed = 1);

}  // namespace ahm::test
