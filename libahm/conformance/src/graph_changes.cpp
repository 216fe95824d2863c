#include "ahm/conformance/graph_changes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "matrices.hpp"

namespace ahm::test {

CsrGraphData stored(const TangentGraph& graph) {
  CsrGraphData g;
  g.dimension = graph.dimension();
  g.kind = graph.transport_kind();
  g.length_unit = graph.length_unit();
  g.mean_edge_length = graph.mean_edge_length();
  g.row_begin = {0};
  auto append = [](auto& to, auto from) { to.insert(to.end(), from.begin(), from.end()); };
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    append(g.neighbors, star.neighbors);
    append(g.weights, star.weights);
    append(g.logs, star.logs);
    append(g.transports, star.transports);
    g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
    g.masses.push_back(graph.mass(i));
  }
  return g;
}

CsrGraphData joined(const CsrGraphData& g, const CsrGraphData& other) {
  CsrGraphData two = g;
  const auto n = static_cast<Index>(g.masses.size());
  auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (std::size_t i = 1; i < other.row_begin.size(); ++i)
    two.row_begin.push_back(g.row_begin.back() + other.row_begin[i]);
  for (Index j : other.neighbors) two.neighbors.push_back(j + n);
  append(two.weights, other.weights);
  append(two.logs, other.logs);
  append(two.transports, other.transports);
  append(two.masses, other.masses);
  if (!two.frames.empty()) append(two.frames, other.frames);
  return two;
}

CsrGraphData doubled(const CsrGraphData& g) { return joined(g, g); }

TurnedGraph with_frames_turned(const CsrGraphData& g, unsigned seed) {
  const int d = g.dimension;
  const bool rotations = g.kind == TransportKind::rotation2;
  std::mt19937_64 random(seed);
  std::vector<Matrix> Q;
  TurnedGraph turned{g, {}};
  for (std::size_t i = 0; i < g.masses.size(); ++i) {
    Q.push_back(random_frame(d, random, !rotations && i % 2 == 1));
    turned.turns.insert(turned.turns.end(), Q.back().begin(), Q.back().end());
  }
  const int width = rotations ? 2 : d * d;
  for (std::size_t i = 0; i < g.masses.size(); ++i)
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e) {
      double* log = turned.data.logs.data() + e * d;
      const double* before = g.logs.data() + e * d;
      for (int a = 0; a < d; ++a) {
        log[a] = 0;
        for (int b = 0; b < d; ++b) log[a] += Q[i][a * d + b] * before[b];
      }
      double* R = turned.data.transports.data() + e * width;
      const Matrix block = rotations ? Matrix{R[0], -R[1], R[1], R[0]} : Matrix(R, R + width);
      const Matrix other = product(d, product(d, Q[i], block), transposed(d, Q[g.neighbors[e]]));  // Q_i R_ji Q_j^T
      if (rotations)
        R[0] = other[0], R[1] = other[2];
      else
        std::copy(other.begin(), other.end(), R);
    }
  return turned;
}

CsrGraphData as_blocks(const CsrGraphData& g) {
  CsrGraphData blocks = g;
  blocks.kind = TransportKind::block;
  blocks.transports.clear();
  for (std::size_t e = 0; e < g.neighbors.size(); ++e) {
    const double c = g.transports[2 * e], s = g.transports[2 * e + 1];
    for (double entry : {c, -s, s, c}) blocks.transports.push_back(entry);
  }
  return blocks;
}

CsrGraphData relabeled(const CsrGraphData& g, const std::vector<Index>& order) {
  CsrGraphData result = g;
  std::vector<Index> inverse(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<Index>(i);
  const std::size_t d = static_cast<std::size_t>(g.dimension), width = g.kind == TransportKind::rotation2 ? 2 : d * d;
  Offset at = 0;
  for (std::size_t v = 0; v < order.size(); ++v) {
    const Index i = inverse[v];
    result.masses[v] = g.masses[i];
    result.row_begin[v] = at;
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e, ++at) {
      result.neighbors[at] = order[g.neighbors[e]];
      result.weights[at] = g.weights[e];
      std::copy_n(g.logs.begin() + e * d, d, result.logs.begin() + at * d);
      std::copy_n(g.transports.begin() + e * width, width, result.transports.begin() + at * width);
    }
  }
  return result;
}

CsrGraphData mirrored(const CsrGraphData& g) {
  CsrGraphData result = g;
  for (std::size_t e = 0; e < g.neighbors.size(); ++e) {
    result.logs[2 * e + 1] *= -1;
    result.transports[2 * e + 1] *= -1;
  }
  return result;
}

CsrGraphData scaled(const CsrGraphData& g, double factor) {
  CsrGraphData result = g;
  for (double& x : result.logs) x *= factor;
  for (double& m : result.masses) m *= std::pow(factor, g.dimension);
  for (double& w : result.weights) w *= std::pow(factor, g.dimension - 2);
  if (result.mean_edge_length) *result.mean_edge_length *= factor;
  return result;
}

}  // namespace ahm::test
