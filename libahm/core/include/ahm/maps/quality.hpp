/// \file
/// Where a log map can be trusted.
///
/// \code
/// ahm::LogMap map = solver.solve(source, {.frames = true});
/// std::vector<double> q = ahm::map_quality(graph, map);
/// if (q[i] < ahm::trusted_quality) ...                          // near a cut locus, or folded
/// \endcode
#pragma once

#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"

namespace ahm {

/// Vertices of a lower quality lie at a cut locus, in a fold or in a blend of two sheets, as a rule.
inline constexpr double trusted_quality = 0.5;

/// How well each vertex and its neighbours keep the Gauss lemma: the gradient of |phi|^2 / 2 is phi, transported.
///
///     g_i^2 = mean over edges ij of [((|phi_j|^2 - |phi_i|^2)/2 - e_ij . (U_i phi_i) - |e_ij|^2/2)
///                                    / (|e_ij| max(|phi_i|, |e_ij|))]^2
///     q_i   = 1 / (1 + (g_i / 0.4)^2)
///
/// It is 1 on flat geometry, falls with h on smooth surfaces and stays below 1/2 across a cut locus at any resolution. It
/// sees jumps and folds; a smooth bias, such as that of a mesh too coarse for its features, it cannot see
/// (`LogMap::error_estimate` does). Measured in docs/accuracy.md. Meant for sources in one place: |phi| is not a distance
/// from a curve that carries coordinates of its own.
/// @param threads  0: one per core
/// @return n numbers in (0, 1]; NaN where the map is not ok
/// @throws InvalidArgument when the map has no frames or belongs to another graph
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads = 0);

}  // namespace ahm
