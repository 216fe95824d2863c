/// \file
/// Converts the values of heat at a vertex to its row of the map.
#pragma once

#include <cmath>
#include <span>

#include "ahm/maps/log_map.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// The result of the heat method at a vertex, world units.
struct HeatRow {
  std::span<const double> phi;  ///< coordinates
  double root_mean_square;      ///< sqrt(q / lambda)
  double distance;              ///< `heat_distance`
};

/// The row of a vertex in a map, without its coordinates; lengths in world units.
struct VertexRow {
  Status status;  ///< `unreached` where a number is not finite
  double distance, spread;
};

inline VertexRow vertex_row(const HeatRow& found) {
  const double r = length(found.phi), rms = found.root_mean_square;
  const bool ok = all_finite(found.phi) && std::isfinite(rms) && std::isfinite(found.distance);
  return {ok ? Status::ok : Status::unreached, found.distance, rms > r ? std::sqrt(rms - r) * std::sqrt(rms + r) : 0.0};
}

}  // namespace ahm
