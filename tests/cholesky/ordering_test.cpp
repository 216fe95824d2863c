// Fill-reducing orderings and their parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <random>

#include "ahm/cholesky/cholesky.hpp"
#include "cholesky/bisection.hpp"
#include "cholesky/dissection.hpp"
#include "cholesky/minimum_degree.hpp"
#include "cholesky/patches.hpp"
#include "cholesky/vertex_cut.hpp"

namespace ahm {
namespace {

using Edges = std::vector<std::pair<std::int32_t, std::int32_t>>;

Adjacency graph_of(std::int32_t n, const Edges& edges) {
  std::vector<Numbers> rows(static_cast<std::size_t>(n));
  for (const auto& [i, j] : edges) rows[i].push_back(j), rows[j].push_back(i);
  Adjacency graph;
  for (const Numbers& row : rows) {
    graph.neighbors.insert(graph.neighbors.end(), row.begin(), row.end());
    graph.end_row();
  }
  return graph;
}

Edges grid_edges(std::int32_t width, std::int32_t height) {
  Edges edges;
  for (std::int32_t y = 0; y < height; ++y)
    for (std::int32_t x = 0; x < width; ++x) {
      if (x + 1 < width) edges.emplace_back(y * width + x, y * width + x + 1);
      if (y + 1 < height) edges.emplace_back(y * width + x, (y + 1) * width + x);
      if (x + 1 < width && y + 1 < height) edges.emplace_back(y * width + x, (y + 1) * width + x + 1);
    }
  return edges;
}

SparseUpper pattern_of(const Adjacency& graph) {
  SparseUpper K;
  K.column_begin = {0};
  for (std::int32_t j = 0; j < graph.size(); ++j) {
    Numbers rows(graph.of(j).begin(), graph.of(j).end());
    std::erase_if(rows, [&](std::int32_t i) { return i > j; });
    rows.push_back(j);
    std::ranges::sort(rows);
    K.rows.insert(K.rows.end(), rows.begin(), rows.end());
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  K.values.assign(K.rows.size(), 1);
  return K;
}

/// Sum of the squared column counts of the factor, by elimination of one vertex after another.
double operations(const Adjacency& graph, const Numbers& order) {
  std::vector<std::vector<bool>> joined(order.size(), std::vector<bool>(order.size(), false));
  for (std::int32_t v = 0; v < graph.size(); ++v)
    for (const std::int32_t w : graph.of(v)) joined[v][w] = true;
  std::vector<bool> gone(order.size(), false);
  double sum = 0;
  for (const std::int32_t v : order) {
    gone[v] = true;
    Numbers later;
    for (std::int32_t w = 0; w < graph.size(); ++w)
      if (joined[v][w] && !gone[w]) later.push_back(w);
    for (const std::int32_t a : later)
      for (const std::int32_t b : later) joined[a][b] = a != b;
    sum += static_cast<double>((later.size() + 1) * (later.size() + 1));
  }
  return sum;
}

bool is_permutation(Numbers order, std::int32_t n) {
  std::ranges::sort(order);
  Numbers all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return order == all;
}

/// Whether no path without vertices of the cut joins the ends.
bool separates(const Adjacency& graph, const std::vector<End>& ends, std::uint32_t cut) {
  Numbers queue;
  std::vector<bool> seen(ends.size(), false);
  for (std::int32_t v = 0; v < graph.size(); ++v)
    if (ends[v] == End::first && (cut >> v & 1) == 0) seen[v] = true, queue.push_back(v);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    if (ends[queue[k]] == End::second) return false;
    for (const std::int32_t w : graph.of(queue[k]))
      if (!seen[w] && (cut >> w & 1) == 0) seen[w] = true, queue.push_back(w);
  }
  return true;
}

TEST(SmallestVertexCut, IsAsSmallAsTheSmallestOfAllSubsets) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const std::int32_t n = 4 + static_cast<std::int32_t>(random() % 7);
    Edges edges;
    for (std::int32_t i = 0; i < n; ++i)
      for (std::int32_t j = 0; j < i; ++j)
        if (random() % 3 == 0) edges.emplace_back(i, j);
    const Adjacency graph = graph_of(n, edges);
    std::vector<End> ends(static_cast<std::size_t>(n), End::none);
    for (std::int32_t k = 0; k < n / 3; ++k) ends[k] = End::first, ends[n - 1 - k] = End::second;
    const std::vector<Part> parts = smallest_vertex_cut(graph, ends);
    std::uint32_t cut = 0;
    for (std::int32_t v = 0; v < n; ++v)
      if (parts[v] == Part::cut) cut |= 1U << v;
    EXPECT_TRUE(separates(graph, ends, cut)) << trial;
    int least = n;
    for (std::uint32_t subset = 0; subset < 1U << n; ++subset)
      if (separates(graph, ends, subset)) least = std::min(least, std::popcount(subset));
    EXPECT_EQ(std::popcount(cut), least) << trial;
    for (const auto& [i, j] : edges)
      EXPECT_TRUE(parts[i] == parts[j] || parts[i] == Part::cut || parts[j] == Part::cut) << trial;
  }
}

TEST(Bisection, CutsAStripAcross) {
  const Adjacency graph = graph_of(600, grid_edges(60, 10));
  const WeightedGraph weighted{graph, Numbers(graph.neighbors.size(), 1), Numbers(600, 1)};
  const auto sides = bisect(weighted);
  int cut = 0;
  for (std::int32_t v = 0; v < 600; ++v)
    for (const std::int32_t w : graph.of(v)) cut += sides[v] < sides[w];
  const auto first = std::ranges::count(sides, 0);
  EXPECT_GE(std::min(first, 600 - first), 200);
  EXPECT_LE(cut, 19);  // a straight cut: 10 edges and 9 diagonals
}

TEST(Bisection, LeavesNoSideEmpty) {
  for (const Numbers& weights : {Numbers{1, 1}, Numbers{1000, 1}, Numbers{1, 1000}, Numbers{1, 1, 1000, 1}}) {
    const auto n = static_cast<std::int32_t>(weights.size());
    for (const bool connected : {false, true}) {
      const Adjacency graph = graph_of(n, connected ? grid_edges(n, 1) : Edges{});
      const auto sides = bisect({graph, Numbers(graph.neighbors.size(), 1), weights});
      EXPECT_TRUE(std::ranges::count(sides, 0) > 0 && std::ranges::count(sides, 1) > 0) << n;
    }
  }
}

TEST(Patches, CoverTheGraphWithConnectedParts) {
  Edges edges = grid_edges(70, 40);
  for (std::int32_t v = 2800; v < 2810; ++v) edges.emplace_back(v, 2800 + (v + 1) % 10);  // another component
  const Adjacency graph = graph_of(2811, edges);                                          // and a single vertex
  const Patches patches = patches_of(graph, 50);
  std::vector<int> size(static_cast<std::size_t>(patches.count), 0), components(size);
  std::vector<bool> seen(2811, false);
  for (std::int32_t v = 0; v < 2811; ++v) {
    ++size[patches.of_vertex[v]];
    if (seen[v]) continue;
    ++components[patches.of_vertex[v]];
    Numbers queue{v};
    seen[v] = true;
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const std::int32_t w : graph.of(queue[k]))
        if (!seen[w] && patches.of_vertex[w] == patches.of_vertex[v]) seen[w] = true, queue.push_back(w);
  }
  for (const int count : components) EXPECT_EQ(count, 1);
  EXPECT_LE(*std::ranges::max_element(size), 150);
  EXPECT_LE(patches.count, 150);
}

TEST(MinimumDegree, FillsNoTreeAndCountsOtherNeighbors) {
  Edges edges;
  for (std::int32_t v = 1; v < 127; ++v) edges.emplace_back(v, (v - 1) / 2);
  const Adjacency tree = graph_of(127, edges);
  Numbers all(127);
  std::iota(all.begin(), all.end(), 0);
  const double least = 126 * 4 + 1;  // each column has its diagonal and its parent
  EXPECT_EQ(operations(tree, minimum_degree(tree, all)), least);
  // Vertex 0 has one neighbor among the vertices and three others, vertex 1 has two.
  const Adjacency graph = graph_of(7, {{0, 1}, {0, 4}, {0, 5}, {0, 6}, {1, 2}, {2, 3}});
  EXPECT_EQ(minimum_degree(graph, Numbers{0, 1, 2, 3}).back(), 0);
}

TEST(NestedDissection, IsAPermutationOfAnyGraphOnAnyNumberOfThreads) {
  std::mt19937 random(3);
  Edges star, two = grid_edges(60, 30), complete, random_edges;
  for (std::int32_t v = 1; v < 3000; ++v) star.emplace_back(0, v), star.emplace_back(v, v % 2999 + 1);
  for (const auto& [i, j] : grid_edges(40, 40)) two.emplace_back(1800 + i, 1800 + j);
  for (std::int32_t i = 0; i < 300; ++i)
    for (std::int32_t j = 0; j < i; ++j) complete.emplace_back(i, j);
  for (std::int32_t v = 1; v < 2000; ++v)
    for (int k = 0; k < 3; ++k) random_edges.emplace_back(v, static_cast<std::int32_t>(random() % v));
  std::ranges::sort(random_edges);
  random_edges.erase(std::unique(random_edges.begin(), random_edges.end()), random_edges.end());
  const std::pair<std::int32_t, Edges> cases[]{{0, {}},
                                               {1, {}},
                                               {500, {}},
                                               {3000, star},
                                               {3500, two},
                                               {300, complete},
                                               {2000, random_edges},
                                               {4900, grid_edges(70, 70)}};
  for (const auto& [n, edges] : cases) {
    const Adjacency graph = graph_of(n, edges);
    const Numbers order = nested_dissection(graph, 1);
    EXPECT_TRUE(is_permutation(order, n)) << n;
    EXPECT_EQ(nested_dissection(graph, 2), order) << n;
    EXPECT_EQ(nested_dissection(graph, 5), order) << n;
  }
}

TEST(NestedDissection, NeedsFewOperationsOnAGrid) {
  const Adjacency graph = graph_of(40 * 40, grid_edges(40, 40));
  const double dissected = operations(graph, nested_dissection(graph, 1));
  EXPECT_LT(dissected, 1.1 * operations(graph, approximate_minimum_degree(graph)));
  const SparseUpper K = pattern_of(graph);
  EXPECT_EQ(SymbolicCholesky(K, Ordering::nested_dissection).operations(), dissected);
}

TEST(AutomaticOrdering, NeedsTheFewestOperationsOfLargeFactors) {
  for (const std::int32_t side : {6, 30}) {
    Edges cube;
    for (std::int32_t v = 0; v < side * side * side; ++v) {
      if (v % side + 1 < side) cube.emplace_back(v, v + 1);
      if (v / side % side + 1 < side) cube.emplace_back(v, v + side);
      if (v / side / side + 1 < side) cube.emplace_back(v, v + side * side);
    }
    const SparseUpper K = pattern_of(graph_of(side * side * side, cube));
    const double degree = SymbolicCholesky(K, Ordering::amd).operations(),
                 dissection = SymbolicCholesky(K, Ordering::nested_dissection).operations();
    EXPECT_EQ(SymbolicCholesky(K).operations(), side < 10 ? degree : dissection);
    if (side > 10) EXPECT_LT(dissection, 0.8 * degree);
  }
}

}  // namespace
}  // namespace ahm
