#include "cholesky/minimum_degree.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <bit>
#include <numeric>

namespace ahm {

Numbers approximate_minimum_degree(const Adjacency& graph) {
  const std::int32_t n = graph.size();
  Numbers begin{0}, rows;
  begin.reserve(graph.begin.size());
  rows.reserve(graph.neighbors.size() + graph.begin.size());
  for (std::int32_t v = 0; v < n; ++v) {
    const auto row = graph.of(v);
    rows.insert(rows.end(), row.begin(), row.end());
    rows.push_back(v);  // Eigen takes columns without a diagonal entry for dense ones
    begin.push_back(static_cast<std::int32_t>(rows.size()));
  }
  const std::vector<char> values(rows.size());  // not read
  const Eigen::Map<const Eigen::SparseMatrix<char, Eigen::ColMajor, std::int32_t>> matrix(
      n, n, begin.back(), begin.data(), rows.data(), values.data());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, std::int32_t> order;
  Eigen::AMDOrdering<std::int32_t>()(matrix.selfadjointView<Eigen::Upper>(), order);
  return {order.indices().begin(), order.indices().begin() + n};
}

Numbers minimum_degree(const Adjacency& graph, std::span<const std::int32_t> vertices) {
  Numbers all(vertices.begin(), vertices.end());
  for (const std::int32_t v : vertices) {
    const auto row = graph.of(v);
    all.insert(all.end(), row.begin(), row.end());
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const auto place = [&](std::int32_t v) {
    return static_cast<std::size_t>(std::ranges::lower_bound(all, v) - all.begin());
  };

  const std::size_t words = (all.size() + 63) / 64;
  std::vector<std::uint64_t> bits(vertices.size() * words, 0);
  Numbers row_of(all.size(), -1);  // -1: not among `vertices`
  for (std::size_t k = 0; k < vertices.size(); ++k) row_of[place(vertices[k])] = static_cast<std::int32_t>(k);
  Numbers degree, waiting;  // waiting: rows
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const auto row = graph.of(vertices[k]);
    for (const std::int32_t w : row) {
      const std::size_t bit = place(w);
      bits[k * words + bit / 64] |= std::uint64_t{1} << bit % 64;
    }
    degree.push_back(static_cast<std::int32_t>(row.size()));
    waiting.push_back(static_cast<std::int32_t>(k));
  }

  Numbers order;
  while (!waiting.empty()) {
    const auto next = std::ranges::min_element(waiting, {}, [&](std::int32_t k) { return degree[k]; });
    const std::int32_t k = *next;
    waiting.erase(next);
    order.push_back(vertices[k]);
    const std::uint64_t* row = bits.data() + k * words;
    const std::size_t own = place(vertices[k]);
    for (std::size_t word = 0; word < words; ++word)
      for (std::uint64_t rest = row[word]; rest != 0; rest &= rest - 1) {
        const std::size_t bit = 64 * word + static_cast<std::size_t>(std::countr_zero(rest));
        const std::int32_t j = row_of[bit];
        if (j < 0) continue;
        std::uint64_t* other = bits.data() + j * words;
        degree[j] = 0;
        for (std::size_t i = 0; i < words; ++i) other[i] |= row[i];
        for (const std::size_t gone : {own, bit}) other[gone / 64] &= ~(std::uint64_t{1} << gone % 64);
        for (std::size_t i = 0; i < words; ++i) degree[j] += std::popcount(other[i]);
      }
    row_of[own] = -1;
  }
  return order;
}

}  // namespace ahm
