#include "cholesky/ordering.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "ahm/error.hpp"
#include "cholesky/dissection.hpp"
#include "cholesky/minimum_degree.hpp"

namespace ahm {
namespace {

Adjacency adjacency(const SparseUpper& pattern) {
  const auto for_each_edge = [&](const auto& visit) {
    for (Offset j = 0; j < pattern.size(); ++j)
      for (Offset p = pattern.column_begin[j]; p < pattern.column_begin[j + 1]; ++p)
        if (pattern.rows[p] != j) visit(static_cast<std::int32_t>(pattern.rows[p]), static_cast<std::int32_t>(j));
  };
  if (pattern.rows.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 2)
    throw ResourceExhausted("symbolic analysis: the matrix is too large for the 32-bit ordering");
  Adjacency graph;
  graph.begin.resize(static_cast<std::size_t>(pattern.size()) + 1, 0);
  for_each_edge([&](std::int32_t i, std::int32_t j) { ++graph.begin[i + 1], ++graph.begin[j + 1]; });
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbors.resize(static_cast<std::size_t>(graph.begin.back()));
  Numbers next(graph.begin.begin(), graph.begin.end() - 1);
  for_each_edge([&](std::int32_t i, std::int32_t j) {
    graph.neighbors[next[i]++] = j;
    graph.neighbors[next[j]++] = i;
  });
  return graph;
}

/// Operations of the factorization per column from which nested dissection is worth its time.
constexpr double many_operations = 30'000;

}  // namespace

SymbolicAnalysis ordered_analysis(const SparseUpper& pattern, Ordering ordering, unsigned threads) {
  const Adjacency graph = adjacency(pattern);
  if (ordering == Ordering::nested_dissection) return analyze(pattern, nested_dissection(graph, threads));
  SymbolicAnalysis by_degree = analyze(pattern, approximate_minimum_degree(graph));
  if (ordering == Ordering::amd || by_degree.pattern.operations < many_operations * static_cast<double>(pattern.size()))
    return by_degree;
  SymbolicAnalysis by_dissection = analyze(pattern, nested_dissection(graph, threads));
  return by_dissection.pattern.operations < by_degree.pattern.operations ? std::move(by_dissection)
                                                                         : std::move(by_degree);
}

}  // namespace ahm
