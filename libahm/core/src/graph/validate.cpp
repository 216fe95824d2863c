#include "ahm/graph/validate.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

constexpr double transport_tolerance = 1e-8;
constexpr double weight_tolerance = 1e-10;

std::string edge_name(Index i, Index j) { return "edge " + std::to_string(i) + " -> " + std::to_string(j); }

/// A star that outlives the next call of `TangentGraph::star`.
struct OwnedStar {
  explicit OwnedStar(const Star& s)
      : neighbors(s.neighbors.begin(), s.neighbors.end()),
        weights(s.weights.begin(), s.weights.end()),
        transports(s.transports.begin(), s.transports.end()) {}
  std::vector<Index> neighbors;
  std::vector<double> weights;
  std::vector<double> transports;
};

/// Transport number `edge` of a star, as d x d entries or (cos, sin).
struct TransportAlgebra {
  int d;
  TransportKind kind;

  std::size_t width() const { return kind == TransportKind::rotation2 ? 2 : static_cast<std::size_t>(d) * d; }

  /// Largest entry of R S - id, where S is given as its transpose-free row-major entries.
  double distance_from_inverse(const double* R, const double* S) const {
    if (kind == TransportKind::rotation2)
      return std::max(std::abs(R[0] * S[0] - R[1] * S[1] - 1.0), std::abs(R[0] * S[1] + R[1] * S[0]));
    double worst = 0;
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) {
        double sum = a == b ? -1.0 : 0.0;
        for (int c = 0; c < d; ++c) sum += R[a * d + c] * S[c * d + b];
        worst = std::max(worst, std::abs(sum));
      }
    return worst;
  }

  double distance_from_orthogonal(const double* R) const {
    if (kind == TransportKind::rotation2) return std::abs(R[0] * R[0] + R[1] * R[1] - 1.0);
    double worst = 0;
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) {
        double sum = a == b ? -1.0 : 0.0;
        for (int c = 0; c < d; ++c) sum += R[a * d + c] * R[b * d + c];
        worst = std::max(worst, std::abs(sum));
      }
    return worst;
  }
};

void check_star_shape(const Star& s, Index i, int dimension, std::size_t transport_width) {
  const std::size_t degree = s.degree(), d = static_cast<std::size_t>(dimension);
  if (s.dimension != dimension)
    throw InvalidGraph("star of vertex " + std::to_string(i) + " has dimension " + std::to_string(s.dimension) +
                       ", the graph has " + std::to_string(dimension));
  if (s.weights.size() != degree || s.logs.size() != degree * d || s.transports.size() != degree * transport_width)
    throw InvalidGraph("star of vertex " + std::to_string(i) + ": weights, logs or transports do not match its " +
                       std::to_string(degree) + " neighbours in length");
}

void check_vertex(const TangentGraph& graph, Index i, const TransportAlgebra& algebra) {
  const double mass = graph.mass(i);
  if (!(mass > 0) || !std::isfinite(mass))
    throw InvalidGraph("mass of vertex " + std::to_string(i) + " is " + detail::number(mass) +
                       "; it must be finite and > 0");
  const Star s = graph.star(i);
  check_star_shape(s, i, algebra.d, algebra.width());
  for (std::size_t e = 0; e < s.degree(); ++e) {
    const Index j = s.neighbors[e];
    if (j < 0 || j >= graph.size())
      throw InvalidGraph(edge_name(i, j) + ": the neighbour is outside [0, " + std::to_string(graph.size()) + ")");
    if (j == i) throw InvalidGraph(edge_name(i, j) + ": self loops are not allowed");
    if (!std::isfinite(s.weights[e])) throw InvalidGraph(edge_name(i, j) + ": the weight is not finite");
    if (!all_finite(s.log(e))) throw InvalidGraph(edge_name(i, j) + ": the edge logarithm is not finite");
    if (!(algebra.distance_from_orthogonal(s.transports.data() + e * algebra.width()) <= transport_tolerance))
      throw InvalidGraph(edge_name(i, j) + ": the transport is not orthogonal");
  }
}

/// Matches every edge i -> j with an unused edge j -> i of the same weight and inverse transport.
void check_pair(const OwnedStar& from, Index i, const Star& to, Index j, const TransportAlgebra& algebra) {
  std::vector<bool> used(to.degree(), false);
  std::size_t forward = 0;
  for (std::size_t e = 0; e < from.neighbors.size(); ++e) {
    if (from.neighbors[e] != j) continue;
    ++forward;
    bool weight_seen = false, matched = false;
    for (std::size_t r = 0; r < to.degree() && !matched; ++r) {
      if (to.neighbors[r] != i || used[r]) continue;
      const double w = from.weights[e];
      if (std::abs(to.weights[r] - w) > weight_tolerance * std::abs(w)) continue;
      weight_seen = true;
      const double* R_ji = from.transports.data() + e * algebra.width();
      const double* R_ij = to.transports.data() + r * algebra.width();
      if (!(algebra.distance_from_inverse(R_ji, R_ij) <= transport_tolerance)) continue;
      used[r] = matched = true;
    }
    if (!matched)
      throw InvalidGraph(edge_name(i, j) + (weight_seen
                                                ? ": the transports of the two directions are not inverse to each other"
                                                : ": the reverse edge is missing or has another weight"));
  }
  const auto backward = static_cast<std::size_t>(std::count(to.neighbors.begin(), to.neighbors.end(), i));
  if (forward != backward)
    throw InvalidGraph(edge_name(j, i) + ": " + std::to_string(backward) + " edges, but " + std::to_string(forward) +
                       " in the other direction");
}

}  // namespace

void validate(const TangentGraph& graph) {
  const int d = graph.dimension();
  if (graph.size() < 1) throw InvalidGraph("the graph has no vertices");
  if (d < 1) throw InvalidGraph("dimension " + std::to_string(d) + " must be at least 1");
  if (graph.transport_kind() == TransportKind::rotation2 && d != 2)
    throw InvalidGraph("rotation2 transports need dimension 2, not " + std::to_string(d));
  const double h = graph.mean_edge_length();
  if (!(h > 0) || !std::isfinite(h))
    throw InvalidGraph("mean edge length " + detail::number(h) + " must be finite and > 0");

  const TransportAlgebra algebra{d, graph.transport_kind()};
  for (Index i = 0; i < graph.size(); ++i) check_vertex(graph, i, algebra);
  for (Index i = 0; i < graph.size(); ++i) {
    const OwnedStar from(graph.star(i));
    std::vector<Index> targets = from.neighbors;
    std::sort(targets.begin(), targets.end());
    targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
    // The pair (i, j) is checked from its smaller end; from the larger end only that the smaller one knows of it.
    for (Index j : targets) {
      const Star to = graph.star(j);
      if (j > i)
        check_pair(from, i, to, j, algebra);
      else if (std::find(to.neighbors.begin(), to.neighbors.end(), i) == to.neighbors.end())
        throw InvalidGraph(edge_name(i, j) + ": the reverse edge is missing or has another weight");
    }
  }
}

}  // namespace ahm
