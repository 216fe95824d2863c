/// \file
/// Orderings by minimum degree.
#pragma once

#include <cstdint>
#include <span>

#include "cholesky/adjacency.hpp"

namespace ahm {

/// Approximate minimum degree [ADD04].
/// @return vertices in elimination order
Numbers approximate_minimum_degree(const Adjacency& graph);

/// Exact minimum degree of a few hundred vertices, by bit sets. Other vertices count as neighbors, but are eliminated later.
/// @param vertices  ascending; the rows of `graph` may contain other vertices
/// @return `vertices` in elimination order
Numbers minimum_degree(const Adjacency& graph, std::span<const std::int32_t> vertices);

}  // namespace ahm
