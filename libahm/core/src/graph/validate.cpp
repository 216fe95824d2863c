#include "ahm/graph/validate.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

constexpr double transport_tolerance = 1e-8;
constexpr double weight_tolerance = 1e-10;

std::string edge_name(Index i, Index j) { return "edge " + std::to_string(i) + " -> " + std::to_string(j); }

void check_star_shape(const Star& s, Index i, int dimension, std::size_t transport_width) {
  const std::size_t degree = s.degree(), d = static_cast<std::size_t>(dimension);
  if (s.dimension != dimension)
    throw InvalidGraph("star of vertex " + std::to_string(i) + " has dimension " + std::to_string(s.dimension) +
                       ", the graph has " + std::to_string(dimension));
  if (s.weights.size() != degree || s.logs.size() != degree * d || s.transports.size() != degree * transport_width)
    throw InvalidGraph("star of vertex " + std::to_string(i) + ": weights, logs or transports do not match its " +
                       detail::counted(degree, "neighbor") + " in length");
}

/// @return the degree
std::size_t check_vertex(const TangentGraph& graph, Index i) {
  const double mass = graph.mass(i);
  if (!(mass > 0) || !std::isfinite(mass))
    throw InvalidGraph("mass of vertex " + std::to_string(i) + " is " + detail::number(mass) +
                       "; it must be finite and > 0");
  const Star s = graph.star(i);
  check_star_shape(s, i, graph.dimension(), graph.transport_layout().width());
  for (std::size_t e = 0; e < s.degree(); ++e) {
    const Index j = s.neighbors[e];
    if (j < 0 || j >= graph.size())
      throw InvalidGraph(edge_name(i, j) + ": the neighbor is outside [0, " + std::to_string(graph.size()) + ")");
    if (j == i) throw InvalidGraph(edge_name(i, j) + ": self loops are not allowed");
    if (!std::isfinite(s.weights[e])) throw InvalidGraph(edge_name(i, j) + ": the weight is not finite");
    if (!all_finite(s.log(e))) throw InvalidGraph(edge_name(i, j) + ": the edge logarithm is not finite");
    if (!(s.transport(e).distance_from_orthogonal() <= transport_tolerance))
      throw InvalidGraph(edge_name(i, j) + ": the transport is not orthogonal");
  }
  return s.degree();
}

/// Matches edges with their reverse edges. The object keeps its buffers from vertex to vertex.
class ReverseEdgeCheck {
 public:
  explicit ReverseEdgeCheck(const TangentGraph& graph) : graph_(graph), layout_(graph.transport_layout()) {}

  /// Checks the edges between i and all neighbors j of smaller degree, or of the same degree and larger number. So the time is not
  /// quadratic in the degrees.
  /// @return number of edges i -> j and j -> i that were checked
  std::size_t at(Index i) {
    copy(graph_.star(i));
    const std::size_t degree = neighbors_.size();
    by_target_.resize(degree);
    std::iota(by_target_.begin(), by_target_.end(), std::size_t{0});
    // Equal neighbors are sorted by position: a stable sort that needs no buffer.
    std::sort(by_target_.begin(), by_target_.end(), [&](std::size_t a, std::size_t b) {
      return neighbors_[a] != neighbors_[b] ? neighbors_[a] < neighbors_[b] : a < b;
    });
    std::size_t checked = 0;
    for (std::size_t first = 0, last; first < degree; first = last) {
      const Index j = neighbors_[by_target_[first]];
      for (last = first; last < degree && neighbors_[by_target_[last]] == j;) ++last;
      const Star to = graph_.star(j);
      if (to.degree() > degree || (to.degree() == degree && j < i)) continue;
      match(std::span(by_target_).subspan(first, last - first), i, to, j);
      checked += 2 * (last - first);
    }
    return checked;
  }

 private:
  void copy(const Star& star) {
    neighbors_.assign(star.neighbors.begin(), star.neighbors.end());
    weights_.assign(star.weights.begin(), star.weights.end());
    transports_.assign(star.transports.begin(), star.transports.end());
  }

  /// Matches each edge i -> j with an unused edge j -> i of the same weight and inverse transport.
  /// @param edges  positions in the star of i
  void match(std::span<const std::size_t> edges, Index i, const Star& to, Index j) {
    used_.assign(to.degree(), 0);
    std::size_t backward = 0;
    for (std::size_t r = 0; r < to.degree(); ++r) backward += to.neighbors[r] == i ? 1 : 0;
    for (const std::size_t e : edges) {
      bool has_weight = false, matched = false;
      for (std::size_t r = 0; r < to.degree() && !matched; ++r) {
        if (to.neighbors[r] != i || used_[r] != 0) continue;
        const double w = weights_[e];
        if (std::abs(to.weights[r] - w) > weight_tolerance * std::abs(w)) continue;
        has_weight = true;
        const Transport R_ji(layout_, transports_.data() + e * layout_.width());
        if (!(R_ji.distance_from_inverse(to.transport(r)) <= transport_tolerance)) continue;
        matched = true;
        used_[r] = 1;
      }
      if (!matched)
        throw InvalidGraph(edge_name(i, j) +
                           (has_weight ? ": the transports of the two directions are not inverse to each other"
                                       : ": the reverse edge is missing or has another weight"));
    }
    if (edges.size() != backward)
      throw InvalidGraph(edge_name(j, i) + ": " + detail::counted(backward, "edge") + ", but " +
                         std::to_string(edges.size()) + " in the other direction");
  }

  const TangentGraph& graph_;
  TransportLayout layout_;
  std::vector<Index> neighbors_;              ///< neighbors of i, copied: the next call of `star` invalidates a star
  std::vector<double> weights_, transports_;  ///< weights and transports of the edges of i
  std::vector<std::size_t> by_target_;
  std::vector<std::uint8_t> used_;  ///< whether an edge of j has been matched
};

/// Throws an error for an edge without a reverse edge. Called only if there is one.
[[noreturn]] void throw_missing_reverse(const TangentGraph& graph) {
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    const std::vector<Index> neighbors(star.neighbors.begin(), star.neighbors.end());
    for (Index j : neighbors) {
      const Star to = graph.star(j);
      if (std::find(to.neighbors.begin(), to.neighbors.end(), i) == to.neighbors.end())
        throw InvalidGraph(edge_name(i, j) + ": the reverse edge is missing or has another weight");
    }
  }
  throw InvalidGraph("the graph's stars change from one call to the next");
}

void check_edges(const TangentGraph& graph, unsigned threads) {
  constexpr Offset chunk = 1 << 14;
  std::atomic<std::size_t> edges{0}, checked{0};
  detail::parallel_chunks(graph.size(), chunk, threads, [&](Offset begin, Offset end) {
    std::size_t sum = 0;
    for (Offset i = begin; i < end; ++i) sum += check_vertex(graph, static_cast<Index>(i));
    edges += sum;
  });
  detail::parallel_chunks(graph.size(), chunk, threads, [&](Offset begin, Offset end) {
    ReverseEdgeCheck pairs(graph);
    std::size_t sum = 0;
    for (Offset i = begin; i < end; ++i) sum += pairs.at(static_cast<Index>(i));
    checked += sum;
  });
  if (checked != edges) throw_missing_reverse(graph);
}

}  // namespace

void validate(const TangentGraph& graph, unsigned threads) {
  const int d = graph.dimension();
  if (graph.size() < 1) throw InvalidGraph("the graph has no vertices");
  if (d < 1) throw InvalidGraph("dimension " + std::to_string(d) + " must be at least 1");
  if (graph.transport_kind() == TransportKind::rotation2 && d != 2)
    throw InvalidGraph("rotation2 transports need dimension 2, not " + std::to_string(d));
  const double h = graph.mean_edge_length();
  if (!(h > 0) || !std::isfinite(h))
    throw InvalidGraph("mean edge length " + detail::number(h) + " must be finite and > 0");
  const double unit = graph.length_unit();
  if (!(unit > 0) || !std::isfinite(unit))
    throw InvalidGraph("the unit of length is " + detail::number(unit) + "; it must be finite and > 0");

  try {
    check_edges(graph, threads);
  } catch (const InvalidGraph&) {
    check_edges(graph, 1);  // reports the first violation
    throw;
  }
}

}  // namespace ahm
