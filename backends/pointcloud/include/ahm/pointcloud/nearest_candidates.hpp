/// \file
/// The nearest of candidates, of which several may be equally near. Not part of the public interface.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::pointcloud {

/// Squared distance and number.
using Candidate = std::pair<double, Index>;

/// Puts the `count` nearest, of equally near ones those of lower numbers, into `indices` and `squared_distances`; reorders
/// the candidates.
inline void take_nearest(std::vector<Candidate>& candidates, std::size_t count, std::span<Index> indices,
                         std::span<double> squared_distances) {
  std::sort(candidates.begin(), candidates.end());
  for (std::size_t i = 0; i < count; ++i) {
    squared_distances[i] = candidates[i].first;
    indices[i] = candidates[i].second;
  }
}

}  // namespace ahm::pointcloud
