/// \file
/// Which sources of local maps share a patch.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// Groups of sources near each other: the first that has no group yet, and those around it.
/// @param reach  how far along edges (graph units) a seed looks for others, given its number
/// @return the numbers of the sources of each group
std::vector<std::vector<Index>> groups_of(const TangentGraph& graph, std::span<const Source> sources,
                                          const std::function<double(Index seed)>& reach);

}  // namespace ahm
