#include "ahm/graph/tangent_graph.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

double world_mass(const TangentGraph& graph, double mass) {
  double result = mass;
  for (int a = 0; a < graph.dimension(); ++a) result *= graph.length_unit();
  return mass == 0 || std::isnormal(result) ? result : std::numeric_limits<double>::quiet_NaN();
}

Components connected_components(const TangentGraph& graph) {
  const Index n = graph.size();
  detail::DisjointSets sets(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0) sets.join(i, star.neighbors[e]);
  }
  Components result{std::vector<Index>(static_cast<std::size_t>(n)), 0};
  for (Index i = 0; i < n; ++i) {
    const Index root = sets.root(i);  // the smallest vertex of the component
    result.of_vertex[i] = root == i ? result.count++ : result.of_vertex[root];
  }
  return result;
}

namespace {

void expect_length(const char* name, std::size_t actual, std::size_t expected) {
  if (actual != expected)
    throw InvalidGraph(std::string("CsrGraph: array '") + name + "' has length " + std::to_string(actual) +
                       ", expected " + std::to_string(expected));
}

void check_rows(const CsrGraphData& g) {
  if (g.row_begin.front() != 0 || g.row_begin.back() != static_cast<Offset>(g.neighbors.size()))
    throw InvalidGraph("CsrGraph: 'row_begin' must start at 0 and end at the number of edges, " +
                       std::to_string(g.neighbors.size()));
  for (std::size_t i = 0; i + 1 < g.row_begin.size(); ++i)
    if (g.row_begin[i] > g.row_begin[i + 1])
      throw InvalidGraph("CsrGraph: 'row_begin' decreases after vertex " + std::to_string(i));
  const auto n = static_cast<Index>(g.masses.size());
  for (std::size_t e = 0; e < g.neighbors.size(); ++e)
    if (g.neighbors[e] < 0 || g.neighbors[e] >= n)
      throw InvalidGraph("CsrGraph: neighbor " + std::to_string(g.neighbors[e]) + " of edge " + std::to_string(e) +
                         " is outside [0, " + std::to_string(n) + ")");
}

double mean_log_length(const CsrGraphData& g) {
  const auto d = static_cast<std::size_t>(g.dimension);
  double sum = 0;
  for (std::size_t e = 0; e < g.neighbors.size(); ++e) {
    sum += length(std::span(g.logs).subspan(e * d, d));
  }
  return g.neighbors.empty() ? 1.0 : sum / static_cast<double>(g.neighbors.size());
}

}  // namespace

CsrGraph::CsrGraph(CsrGraphData data) : data_(std::move(data)) {
  const CsrGraphData& g = data_;
  if (g.dimension < 1) throw InvalidGraph("CsrGraph: dimension " + std::to_string(g.dimension) + " must be at least 1");
  const std::size_t n = g.masses.size(), edges = g.neighbors.size(), d = static_cast<std::size_t>(g.dimension);
  expect_length("row_begin", g.row_begin.size(), n + 1);
  expect_length("weights", g.weights.size(), edges);
  expect_length("logs", g.logs.size(), edges * d);
  expect_length("transports", g.transports.size(), edges * TransportLayout{g.kind, g.dimension}.width());
  if (!g.frames.empty()) expect_length("frames", g.frames.size(), n);
  if (!g.component_edge_lengths.empty()) expect_length("component_edge_lengths", g.component_edge_lengths.size(), n);
  check_rows(g);
  if (!data_.mean_edge_length) data_.mean_edge_length = mean_log_length(data_);
}

Star CsrGraph::star(Index vertex) const {
  const auto i = static_cast<std::size_t>(vertex), d = static_cast<std::size_t>(data_.dimension);
  const auto begin = static_cast<std::size_t>(data_.row_begin[i]);
  const auto degree = static_cast<std::size_t>(data_.row_begin[i + 1]) - begin;
  const std::size_t r = TransportLayout{data_.kind, data_.dimension}.width();
  return {data_.dimension,
          {data_.neighbors.data() + begin, degree},
          {data_.weights.data() + begin, degree},
          {data_.logs.data() + begin * d, degree * d},
          {data_.transports.data() + begin * r, degree * r}};
}

std::optional<Frame> CsrGraph::frame(Index vertex) const {
  if (data_.frames.empty()) return std::nullopt;
  return data_.frames[vertex];
}

double mean_edge(const TangentGraph& graph, std::span<const Vertex> vertices) {
  double sum = 0, count = 0;
  for (const Vertex vertex : vertices) {
    const Star star = graph.star(vertex.index);
    for (std::size_t e = 0; e < star.degree(); ++e) sum += length(star.log(e));
    count += static_cast<double>(star.degree());
  }
  return count > 0 ? sum / count * graph.length_unit() : 0;
}

}  // namespace ahm
