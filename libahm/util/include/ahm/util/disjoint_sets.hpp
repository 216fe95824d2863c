/// \file
/// Union-find. Not part of the public interface.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::detail {

/// Disjoint sets of the numbers 0 to n - 1. The root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index root(Index v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    if (a != b) parent_[a > b ? a : b] = a > b ? b : a;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace ahm::detail
