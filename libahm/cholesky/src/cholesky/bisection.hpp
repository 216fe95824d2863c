/// \file
/// Bisection of weighted graphs.
#pragma once

#include <cstdint>
#include <vector>

#include "cholesky/adjacency.hpp"

namespace ahm {

struct WeightedGraph {
  Adjacency graph;
  Numbers edge_weights;  ///< one per entry of `graph.neighbors`
  Numbers weights;       ///< of the vertices, > 0

  std::int32_t size() const { return graph.size(); }
};

/// Neither side of a bisection may be lighter than this share of the total weight.
constexpr double smallest_side = 1.0 / 3;

/// Divides the vertices into two sides with few edges between them. Grows one side from several starts, moves vertices between the sides
/// [FM82], and returns the best result.
/// @param graph  two vertices or more
/// @return side of each vertex, 0 or 1. Neither is empty; a side is lighter than `smallest_side` only if a vertex is heavy
std::vector<std::uint8_t> bisect(const WeightedGraph& graph);

}  // namespace ahm
