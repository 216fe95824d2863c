/// \file
/// The order and the directions of passes.
#pragma once

#include <vector>

#include "tool_path/track.hpp"

namespace ahm {

/// A pass as a track; a closed one ends at its first point.
struct TrackedPass {
  Track track;
  PassOrigin origin;
  double distance;  ///< from the seed
  bool closed;

  const Vec3& first() const { return track.front().position; }
  const Vec3& last() const { return track.back().position; }
};

/// Orders passes by their nearest ends, starting with the farthest pass from the seed, and improves the order by exchanges.
/// @param one_way  all passes run in the direction of the seed; false: directions alternate to shorten the links
std::vector<TrackedPass> ordered(std::vector<TrackedPass> passes, bool one_way);

}  // namespace ahm
