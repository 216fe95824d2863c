/// \file
/// Second order: maps of several diffusion times, extrapolated to time zero (docs/accuracy.md).
#pragma once

#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"

namespace ahm {

/// The times of one order, as factors of t_coef: {1}, or {1, c, 2c} with c = n^(1/d) / 50, or {1, 2} on graphs where that
/// is less than 2. Longer times shrink the error that comes from the mesh's directions, ~ 1/c, and extrapolation removes
/// the one in sqrt(tau) that grows with them.
std::vector<double> diffusion_times(int order, const TangentGraph& graph);

/// Coordinates extrapolated vertex by vertex from the maps of one source at these times (factors of t_coef).
///
///     phi* = phi(c) + (phi(c) - phi(2c)) / (sqrt 2 - 1)
///     a    = |phi(2c) - phi(c)| / (sqrt(tau_2c) - sqrt(tau_c)),   w = clamp((a - 3)/2, 0, 1)
///     phi  = (1 - w) phi* + w phi(1)
///
/// a is about 1 where phi is smooth in sqrt(tau); where it is not (cut loci), the shortest time is kept. A vertex that
/// lacks coordinates at any of the times keeps that status.
LogMap extrapolate(const TangentGraph& graph, double t_coef, const std::vector<double>& times,
                   const std::vector<const LogMap*>& maps, double radius);

}  // namespace ahm
