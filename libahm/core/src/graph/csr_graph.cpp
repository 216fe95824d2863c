#include "ahm/graph/csr_graph.hpp"

#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {
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
      throw InvalidGraph("CsrGraph: neighbour " + std::to_string(g.neighbors[e]) + " of edge " + std::to_string(e) +
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

}  // namespace ahm
