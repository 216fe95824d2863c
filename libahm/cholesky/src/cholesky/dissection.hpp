/// \file
/// Nested dissection: separators are eliminated last, the parts between them first [Geo73].
///
/// The graph is covered by patches of some 100 vertices [ZMD26]. The graph of patches is bisected recursively. In a band around the border
/// between two sides, the smallest vertex separator is found by maximum flow. The last parts are ordered by minimum degree.
#pragma once

#include <cstdint>
#include <vector>

#include "cholesky/adjacency.hpp"

namespace ahm {

/// @return vertices in elimination order; independent of the number of threads
Numbers nested_dissection(const Adjacency& graph, unsigned threads);

}  // namespace ahm
