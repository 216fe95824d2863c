/// \file
/// An unfolding front that can be cancelled.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/unfolding_front.hpp"

namespace ahm {

/// The front of a source, as far as `radius` (world units), some edges at a time.
/// @throws InvalidArgument (the source), Cancelled
inline UnfoldingFront unfolded_front(const TangentGraph& graph, std::shared_ptr<const UnfoldingFront::Stars> stars,
                                     const Source& source, double radius, const std::stop_token& stop) {
  UnfoldingFront front(graph, std::move(stars));
  front.add(source);
  const double some_edges = 16 * graph.mean_edge_length() * graph.length_unit();
  for (double next = front.next(); next <= radius && std::isfinite(next); next = front.next()) {
    if (stop.stop_requested()) throw Cancelled("cancelled during unfold");
    front.run(std::min(radius, 1.01 * next + some_edges));
  }
  return front;
}

}  // namespace ahm
