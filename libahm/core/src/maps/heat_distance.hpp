/// \file
/// The distance that heat knows.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// How distances are measured: unfolded on triangulations and from curves, elsewhere by the second moment of heat.
inline bool unfolds(const TangentGraph& graph, const Source& source) {
  return graph.is_delaunay() || source.is_curve();
}

/// From |phi| and the root mean square of z at a vertex, all in the same unit.
///
/// The root mean square holds at cut loci, where vectors cancel; within a few times sqrt(tau) of the source, where heat has
/// taken all ways there are, it is too long, and |phi| is right. Both are exact on flat graphs.
inline double heat_distance(double length, double root_mean_square, double root_tau) {
  const double w = std::clamp(0.5 * (root_mean_square / root_tau - 2), 0.0, 1.0);
  return length + w * (root_mean_square - length);
}

/// How far the direction of phi is that of one way: not where |phi| is much shorter than the distance, since there several
/// ways cancel.
inline double trust_in_direction(double length, double distance) {
  return std::clamp((length / distance - 0.8) / 0.15, 0.0, 1.0);
}

/// Puts a source's own vertices at the distances it was given with, which are known better than by the root of a difference:
/// each at that from the nearest of its points.
inline void place_source(const Source& source, std::span<double> distances) {
  const auto of_samples = [&](const auto& each) {
    for (std::size_t k = 0; k < source.vertices().size(); ++k)
      if (source.weights()[k] > 0) each(distances[source.vertices()[k].index], source.place(k).distance);
  };
  of_samples([](double& distance, double) { distance = std::numeric_limits<double>::infinity(); });
  of_samples([](double& distance, double given) { distance = std::min(distance, given); });
}

}  // namespace ahm
