/// \file
/// The distance that heat knows.
#pragma once

#include <algorithm>

namespace ahm {

/// From |phi| and the root mean square of z at a vertex, all in the same unit.
///
/// The root mean square holds at cut loci, where vectors cancel; within a few times sqrt(tau) of the source, where heat has
/// taken all ways there are, it is too long, and |phi| is right. Both are exact on flat graphs.
inline double heat_distance(double length, double root_mean_square, double root_tau) {
  const double w = std::clamp(0.5 * (root_mean_square / root_tau - 2), 0.0, 1.0);
  return length + w * (root_mean_square - length);
}

}  // namespace ahm
