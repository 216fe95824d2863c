/// \file
/// Geodesic Voronoi cells and farthest point sampling (Sec. 5; SSC19 Sec. 8.5).
///
/// \code
/// auto seeds = ahm::farthest_points(solver, 0, 12);        // 12 vertices spread evenly, the first is vertex 0
/// auto label = ahm::nearest_source(solver, seeds);         // per vertex: which of the 12 is nearest
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/log_map_solver.hpp"

namespace ahm {

/// For every vertex the position in `vertices` of the source that is nearest by heat; -1 in components without a source.
///
/// Costs 1 + ceil(log2 k) right-hand sides for k sources, not k: the numbers of the sources are diffused bit by bit and
/// the majority of the heat decides. Differs from the largest of k separate heats at most where no source has half of
/// the heat, i.e. about one edge around points that are equally far from three sources. Every cell is connected: what is
/// not joined to its source, or beyond the reach of heat, goes to the nearest cell by edge lengths.
/// @throws InvalidArgument (empty, index, a vertex given twice), ResourceExhausted
std::vector<Index> nearest_source(const LogMapSolver& solver, std::span<const Index> vertices);

/// `count` vertices, each the farthest from those before it, beginning with `first`; vertices of components without one
/// count as infinitely far. One solve per vertex; distances are lengths of log maps.
/// @throws InvalidArgument (index, count not in [1, n]); as LogMapSolver::solve
std::vector<Index> farthest_points(const LogMapSolver& solver, Index first, Index count,
                                   const MapOptions& options = {});

}  // namespace ahm
