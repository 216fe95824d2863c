/// \file
/// Counts the work of a map without solving: the size of the factored systems, and the vertices and bands of a march.
#pragma once

#include <span>

#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/source.hpp"
#include "maps/march.hpp"

namespace ahm {

/// Size of the scalar system of a part of a graph.
struct SystemSize {
  double vertices = 0, edges = 0;  ///< number of vertices and of directed edges
  double nonzeros = 0;             ///< entries of the factor
  double operations = 0;           ///< floating-point operations of the factorization
};

/// Measures a system by symbolic analysis.
/// @param vertices  ascending
SystemSize system_size(const TangentGraph& graph, std::span<const Index> vertices, const HeatOptions& options);
SystemSize system_size(const TangentGraph& graph, const HeatOptions& options);

/// Work of a march.
struct MarchWork {
  double reached = 0;  ///< vertices that the march visits
  double solved = 0;   ///< sum of the numbers of vertices of all bands, which overlap
  Index bands = 0;
  SystemSize largest;  ///< size of the largest band
};

/// Estimates the work of a march from shortest edge paths. The march itself measures by its heat how far it came.
/// @param radius  world units
MarchWork march_work(const TangentGraph& graph, const Source& source, const MarchScales& scales, double radius,
                     const HeatOptions& options);

}  // namespace ahm
