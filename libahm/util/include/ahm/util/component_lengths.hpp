/// \file
/// Mean edge lengths of the connected components of a mesh.
#pragma once

#include <vector>

#include "ahm/util/disjoint_sets.hpp"

namespace ahm::detail {

/// Computes the mean edge length of each component from edges added one at a time.
class ComponentLengths {
 public:
  explicit ComponentLengths(std::size_t vertices) : parts_(vertices), vertices_(vertices) {}

  void add(Index a, Index b, double length) {
    parts_.join(a, b);
    edges_.push_back({a, length});
  }

  /// Mean edge length of each vertex's component; empty if there is only one component.
  std::vector<double> means() {
    std::vector<double> sum(vertices_, 0.0), count(vertices_, 0.0);
    for (const Edge& e : edges_) {
      const Index part = parts_.root(e.vertex);
      sum[part] += e.length;
      ++count[part];
    }
    std::vector<double> result(vertices_);
    bool several = false;
    for (std::size_t v = 0; v < vertices_; ++v) {
      const Index part = parts_.root(static_cast<Index>(v));
      result[v] = count[part] > 0 ? sum[part] / count[part] : 0;
      several = several || part != parts_.root(0);
    }
    return several ? result : std::vector<double>();
  }

 private:
  struct Edge {
    Index vertex;
    double length;
  };
  DisjointSets parts_;
  std::size_t vertices_;
  std::vector<Edge> edges_;
};

}  // namespace ahm::detail
