/// \file
/// Undirected graphs in compressed rows, for orderings.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ahm {

using Numbers = std::vector<std::int32_t>;

struct Adjacency {
  Numbers begin{0};   ///< vertices + 1
  Numbers neighbors;  ///< each edge twice, without the diagonal

  std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
  std::span<const std::int32_t> of(std::int32_t vertex) const {
    return std::span(neighbors).subspan(static_cast<std::size_t>(begin[vertex]),
                                        static_cast<std::size_t>(begin[vertex + 1] - begin[vertex]));
  }
  /// Ends the row of the last vertex.
  void end_row() { begin.push_back(static_cast<std::int32_t>(neighbors.size())); }
};

}  // namespace ahm
