/// \file
/// Covers of a graph by connected patches of similar size.
#pragma once

#include <cstdint>

#include "cholesky/adjacency.hpp"

namespace ahm {

struct Patches {
  Numbers of_vertex;
  std::int32_t count = 0;
};

/// Patches of about `size` vertices: breadth-first balls, made rounder by growing them again from their centers.
Patches patches_of(const Adjacency& graph, std::int32_t size);

}  // namespace ahm
