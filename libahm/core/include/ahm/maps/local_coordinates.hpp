/// \file
/// Where chosen vertices lie in the log maps of many sources, each known on its surroundings only.
///
/// \code
/// // The charts of an atlas: of every source the vertices of its own cell.
/// std::vector<double> phi = ahm::local_coordinates(graph, sources, regions);
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// The coordinates of the vertices of regions[s] in the map of sources[s]. Every map is solved for on what lies no farther from its
/// source along edges than the farthest of its vertices, and a margin; sources near each other share one factorization. Work
/// and memory depend on these patches, however large the graph is.
/// @param heat    t_coef, variant, check_graph, threads, progress (stage "solve")
/// @param margin  in units of sqrt(tau), as `LocalMapOptions::margin`: at 16 the difference to the map of the whole graph is 1e-11 of
///                the distance at most, on flat pieces none
/// @return d numbers per vertex, region by region, world units; NaN where no heat arrives, as in other components
/// @throws InvalidArgument (options, sources, vertices, sizes), InvalidGraph, NotPositiveDefinite (of a patch), ResourceExhausted,
/// Cancelled
std::vector<double> local_coordinates(const TangentGraph& graph, std::span<const Source> sources,
                                      std::span<const std::span<const Vertex>> regions, const HeatOptions& heat = {},
                                      double margin = 16);

}  // namespace ahm
