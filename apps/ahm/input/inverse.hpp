/// \file
/// What carries coordinates back to space.
#pragma once

#include "ahm/applications/inverse_map.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// The inverse of a map with frames: for meshes on the rows and faces of the input, so that points lie on them whatever
/// the graph looks like (of several vertices of a row the one nearest to the source counts), for clouds on the graph.
InverseMap inverse_of(const Input& input, const LogMap& map, double min_quality);

}  // namespace ahm::app
