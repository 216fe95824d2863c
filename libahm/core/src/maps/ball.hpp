/// \file
/// Vertices around others, as often as wanted, at a cost that does not depend on the size of the graph.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// n values that are zero until written, of which only those written take memory.
template <class T>
class SparseArray {
 public:
  explicit SparseArray(std::size_t n) : values_(static_cast<T*>(std::calloc(std::max<std::size_t>(n, 1), sizeof(T)))) {
    if (!values_) throw std::bad_alloc();
  }
  T& operator[](Index i) { return values_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> values_;
};

/// Shortest paths along edges from many starts, to a limit; leaves no trace behind.
class Ball {
 public:
  explicit Ball(const TangentGraph& graph) : graph_(graph), known_(static_cast<std::size_t>(graph.size())) {}

  /// Calls visit(vertex, distance) in order of distance for all vertices within `limit` (graph units) of the starts, until it
  /// returns false.
  template <class Visit>
  void grow(std::span<const Vertex> starts, double limit, const Visit& visit) {
    for (Vertex start : starts) offer(start.index, 0);
    bool more = true;
    paths_.run([&](Index vertex, double key) {
      if (!more || !(more = visit(vertex, key - 1))) return;
      const Star star = graph_.star(vertex);
      for (std::size_t e = 0; e < star.degree(); ++e)
        if (const double next = key - 1 + length(star.log(e)); star.weights[e] != 0 && next <= limit)
          offer(star.neighbors[e], next);
    });
    for (Index vertex : touched_) known_[vertex] = 0;
    touched_.clear();
  }

 private:
  void offer(Index vertex, double distance) {
    if (known_[vertex] == 0) touched_.push_back(vertex);
    paths_.offer(vertex, 1 + distance);
  }

  const TangentGraph& graph_;
  SparseArray<double> known_;  ///< 1 + distance, 0: none
  ShortestPaths<double, SparseArray<double>> paths_{known_, 0.0};
  std::vector<Index> touched_;
};

}  // namespace ahm
