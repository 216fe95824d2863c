/// \file
/// Geodesic Voronoi cells and farthest point sampling ([SS25] Sec. 5; [SSC19] Sec. 8.5).
///
/// \code
/// auto seeds = ahm::farthest_points(solver, ahm::Vertex{0}, 12);        // 12 vertices spread evenly, the first is vertex 0
/// auto label = ahm::nearest_source(solver, seeds);         // per vertex: which of the 12 is nearest
/// auto away = ahm::distance_in_cells(solver, seeds, label);  // and how far away it is
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/fields/vector_heat.hpp"

namespace ahm {

/// For every vertex the position in `vertices` of the source that is nearest by heat; -1 in components without a source.
///
/// Costs 1 + ceil(log2 k) right-hand sides for k sources, not k: the numbers of the sources are diffused bit by bit and
/// the majority of the heat decides. Differs from the largest of k separate heats at most where no source has half of
/// the heat, i.e. about one edge around points that are equally far from three sources. Every cell is connected: what is
/// not joined to its source, or beyond the reach of heat, goes to the nearest cell by edge lengths.
/// @throws InvalidArgument (empty, index, a vertex given twice), ResourceExhausted
std::vector<Index> nearest_source(const LogMapSolver& solver, std::span<const Vertex> vertices);

/// The distance of every vertex from the source of its cell, up to the border, where the radial field of all sources
/// together vanishes: sources are solved together whose cells neither touch nor touch a common one, in about 20 solves
/// whatever their number.
/// @param labels  of `nearest_source`; vertices with -1 get `Status::disconnected`
/// @return width 1, world units
/// @throws InvalidArgument (lengths, a label out of range); as `nearest_source` and `distance_and_gradient`
VertexField distance_in_cells(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const Index> labels);

/// `count` vertices, each the farthest from those before it, beginning with `first`; vertices of components without one
/// count as infinitely far. One solve per vertex; distances are lengths of log maps.
/// @throws InvalidArgument (index, count not in [1, n]); as LogMapSolver::solve
std::vector<Vertex> farthest_points(const LogMapSolver& solver, Vertex first, Index count);

}  // namespace ahm
