/// \file
/// Finds the farthest vertex repeatedly, while distances shrink.
///
/// \code
/// ahm::FarthestQueue farthest(vertices);
/// const ahm::Vertex vertex = farthest.of([&](ahm::Vertex v) { return front.distance(v); });
/// \endcode
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// A heap of distances that may be outdated. A distance is updated only when its vertex is on top; if it has shrunk, the
/// vertex moves down.
class FarthestQueue {
 public:
  /// All distances start as infinity. @param vertices  in ascending order
  explicit FarthestQueue(std::span<const Vertex> vertices) {
    heap_.reserve(vertices.size());
    for (const Vertex vertex : vertices) heap_.push_back({std::numeric_limits<double>::infinity(), vertex.index});
  }

  /// The farthest vertex; of several the first.
  /// @param distance  distance of a vertex: not larger than in previous calls, not NaN
  template <class Distance>
  Vertex of(const Distance& distance) {
    for (;;) {
      const Entry top = heap_.front();
      const double now = distance(Vertex(top.vertex));
      if (now == top.distance) return Vertex(top.vertex);
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.back().distance = now;
      std::push_heap(heap_.begin(), heap_.end());
    }
  }

 private:
  struct Entry {
    double distance;
    Index vertex;
    bool operator<(const Entry& other) const {
      return distance != other.distance ? distance < other.distance : vertex > other.vertex;
    }
  };
  std::vector<Entry> heap_;
};

}  // namespace ahm
