/// \file
/// What a source says of its own vertices.
#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "ahm/maps/source.hpp"

namespace ahm {

/// Distance and vector of a source's own vertices as it was given with them, each from the nearest of its points: they are known
/// better than from heat, which smears a point over its neighbours. Of curves the distances alone, since coordinates from curves
/// are no vectors to a point.
class SourceVertices {
 public:
  struct Known {
    double distance;
    std::vector<double> vector;  ///< d numbers, world units; empty: not known
  };

  SourceVertices(const Source& source, int dimension) {
    const auto d = static_cast<std::size_t>(dimension);
    for (std::size_t k = 0; k < source.vertices().size(); ++k) {
      if (!(source.weights()[k] > 0)) continue;
      const double distance = source.place(k).distance;
      const auto [at, is_new] = known_.try_emplace(source.vertices()[k].index);
      if (!is_new && !(distance < at->second.distance)) continue;
      at->second.distance = distance;
      if (source.is_curve()) continue;
      at->second.vector.assign(d, 0.0);
      if (source.offsets().empty()) continue;
      const auto offset = source.offsets().subspan(k * d, d);
      at->second.vector.assign(offset.begin(), offset.end());
    }
  }

  /// Null for other vertices.
  const Known* find(Index vertex) const {
    const auto found = known_.find(vertex);
    return found == known_.end() ? nullptr : &found->second;
  }
  auto begin() const { return known_.begin(); }
  auto end() const { return known_.end(); }

 private:
  std::unordered_map<Index, Known> known_;
};

}  // namespace ahm
