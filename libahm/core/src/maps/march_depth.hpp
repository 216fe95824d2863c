/// \file
/// How deep the bands of a march are, in heat distance.
#pragma once

#include <algorithm>
#include <cmath>

#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// Heat distance accepted per band, where the front is as regular as the graph's edges. Measured: deeper bands cost more
/// fill per vertex, thinner ones solve each vertex more often.
inline constexpr double march_step = 32;

/// How far a band goes beyond what is accepted: what lies ahead by x influences what lies behind by exp(-2 x).
inline double march_margin(double accuracy) { return 1.6 - 0.5 * std::log(accuracy); }

/// How much of the decay exp(-x) of heat an edge brings: its length over sqrt(tau), or what the one edge lets through at
/// the least, where it is far longer than sqrt(tau). An upper bound, for ordering vertices.
/// @param root_tau  sqrt(tau)
/// @param diagonal  called for the diagonal entry m + tau sum w of A at the edge's end, if it is needed
template <class Diagonal>
double edge_heat_distance(double length, double weight, double tau, double root_tau, const Diagonal& diagonal) {
  const double by_length = length / root_tau;
  if (by_length <= 3 || !(weight > 0)) return by_length;
  return std::min(by_length, std::log(diagonal() / (tau * weight)));
}

/// m + tau sum w: the diagonal entry of A.
inline double heat_diagonal(const TangentGraph& graph, Index vertex, double tau) {
  double sum = graph.mass(vertex);
  for (const double w : graph.star(vertex).weights) sum += tau * w;
  return sum;
}

}  // namespace ahm
