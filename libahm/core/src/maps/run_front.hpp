/// \file
/// An unfolding front that can be cancelled.
#pragma once

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "ahm/error.hpp"
#include "ahm/maps/unfolding_front.hpp"

namespace ahm {

/// As `front.run(radius)`, some edges at a time. @param graph  of the front. @throws Cancelled
inline void run_front(UnfoldingFront& front, const TangentGraph& graph, double radius, const std::stop_token& stop) {
  const double some_edges = 16 * graph.mean_edge_length() * graph.length_unit();
  for (double next = front.next(); next <= radius && std::isfinite(next); next = front.next()) {
    if (stop.stop_requested()) throw Cancelled("cancelled during unfold");
    front.run(std::min(radius, 1.01 * std::max(next, 0.0) + some_edges));
  }
}

}  // namespace ahm
