/// \file
/// Dijkstra's algorithm, once for all that grows along edges.
#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// The queue of Dijkstra's algorithm over `known`, the best distance so far by vertex, which the caller provides and
/// clears: anything with known[Index] -> Distance&.
template <class Distance, class Known>
class ShortestPaths {
 public:
  /// @param unset  what `known` holds where nothing is known yet; no vertex is reached at that distance
  ShortestPaths(Known& known, Distance unset) : known_(known), unset_(unset) {}

  /// Keeps the distance if it is the least so far.
  /// @return whether it is
  bool offer(Index vertex, Distance distance) {
    Distance& known = known_[vertex];
    if (distance == unset_ || (known != unset_ && !(distance < known))) return false;
    queue_.push({known = distance, vertex});
    return true;
  }

  /// The least distance of those that wait; some must.
  Distance least() const { return queue_.top().first; }
  bool empty() const { return queue_.empty(); }

  /// Calls settle(vertex, distance) in order of distance, equal ones by number, while it offers more. A distance may come
  /// twice where it was offered so; one that was bettered does not come.
  template <class Settle>
  void run(const Settle& settle) {
    while (!queue_.empty()) {
      const auto [distance, vertex] = queue_.top();
      queue_.pop();
      if (distance == known_[vertex]) settle(vertex, distance);
    }
  }

 private:
  using Entry = std::pair<Distance, Index>;
  Known& known_;
  Distance unset_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace ahm
