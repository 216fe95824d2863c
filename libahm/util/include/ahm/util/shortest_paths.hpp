/// \file
/// Dijkstra's algorithm.
#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// The priority queue of Dijkstra's algorithm. The caller provides and clears `distances`, the smallest distance so far of each vertex.
/// @tparam Distances  any type with distances[Index] -> Distance&
template <class Distance, class Distances>
class ShortestPaths {
 public:
  /// @param unset  value of `distances` for vertices without a distance; not a valid distance
  ShortestPaths(Distances& distances, Distance unset) : distances_(distances), unset_(unset) {}

  /// Stores and queues the distance if it is smaller than the current distance of the vertex.
  /// @return whether it was stored
  bool offer(Index vertex, Distance distance) {
    Distance& known = distances_[vertex];
    if (distance == unset_ || (known != unset_ && !(distance < known))) return false;
    queue_.push({known = distance, vertex});
    return true;
  }

  /// The smallest queued distance. The queue must not be empty.
  Distance least() const { return queue_.top().first; }
  bool empty() const { return queue_.empty(); }

  /// Calls settle(vertex, distance) in order of distance until the queue is empty; `settle` may call `offer`. Equal distances are
  /// ordered by vertex number. Distances that were replaced by smaller ones are skipped. A distance that was queued twice may be
  /// settled twice.
  template <class Settle>
  void run(const Settle& settle) {
    while (!queue_.empty()) {
      const auto [distance, vertex] = queue_.top();
      queue_.pop();
      if (distance == distances_[vertex]) settle(vertex, distance);
    }
  }

 private:
  using Entry = std::pair<Distance, Index>;
  Distances& distances_;
  Distance unset_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace ahm
