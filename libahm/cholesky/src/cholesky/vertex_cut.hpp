/// \file
/// Smallest vertex separators by maximum flow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cholesky/adjacency.hpp"

namespace ahm {

enum class End : std::uint8_t { none, first, second };
enum class Part : std::uint8_t { first, second, cut };

/// A smallest set of vertices whose removal separates the vertices of the first end from those of the second; vertices of the ends may be
/// in it. Of all such sets it is the nearest to the first end. Computed by disjoint paths [Din70].
/// @param ends  for each vertex, the end it belongs to
/// @return the part of each vertex; what is connected to neither end belongs to the second part
std::vector<Part> smallest_vertex_cut(const Adjacency& graph, std::span<const End> ends);

}  // namespace ahm
