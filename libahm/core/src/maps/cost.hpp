/// \file
/// What a map makes of a graph: the systems that are factored and the vertices that a march solves, counted and not solved.
#pragma once

#include <span>

#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/source.hpp"
#include "maps/march.hpp"

namespace ahm {

/// The scalar system of a part of a graph.
struct SystemSize {
  double vertices = 0, edges = 0;  ///< directed ones
  double nonzeros = 0;             ///< of its factor
  double operations = 0;           ///< that the factor takes
};

/// By the symbolic analysis that comes before a factorization.
/// @param vertices  ascending
SystemSize system_size(const TangentGraph& graph, std::span<const Index> vertices, const HeatOptions& options);
SystemSize system_size(const TangentGraph& graph, const HeatOptions& options);

/// By the shortest ways along edges, where the march itself asks the heat how far it came.
struct MarchWork {
  double reached = 0;  ///< vertices that are looked at
  double solved = 0;   ///< vertices of all bands, where they overlap several times
  Index bands = 0;
  SystemSize largest;  ///< band
};

/// @param radius  world units
MarchWork march_work(const TangentGraph& graph, const Source& source, const MarchScales& scales, double radius,
                     const HeatOptions& options);

}  // namespace ahm
