#include "ahm/conformance/flat_graphs.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "matrices.hpp"

namespace ahm::test {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace

Matrix random_frame(int d, std::mt19937_64& random, bool mirror) {
  Matrix Q(static_cast<std::size_t>(d) * d);
  std::normal_distribution<double> normal;
  for (int a = 0; a < d; ++a) {
    for (int c = 0; c < d; ++c) Q[a * d + c] = normal(random);
    for (int pass = 0; pass < 2; ++pass)
      for (int b = 0; b < a; ++b) {
        double dot = 0;
        for (int c = 0; c < d; ++c) dot += Q[a * d + c] * Q[b * d + c];
        for (int c = 0; c < d; ++c) Q[a * d + c] -= dot * Q[b * d + c];
      }
    double norm = 0;
    for (int c = 0; c < d; ++c) norm += Q[a * d + c] * Q[a * d + c];
    for (int c = 0; c < d; ++c) Q[a * d + c] /= std::sqrt(norm);
  }
  // Make the determinant positive, or negative if `mirror`.
  double determinant = 1;
  if (d == 1) determinant = Q[0];
  if (d == 2) determinant = Q[0] * Q[3] - Q[1] * Q[2];
  if (d == 3)
    determinant =
        Q[0] * (Q[4] * Q[8] - Q[5] * Q[7]) - Q[1] * (Q[3] * Q[8] - Q[5] * Q[6]) + Q[2] * (Q[3] * Q[7] - Q[4] * Q[6]);
  if ((determinant < 0) != mirror)
    for (int c = 0; c < d; ++c) Q[(d - 1) * d + c] *= -1;
  return Q;
}

std::vector<double> FlatGraph::exact(Index p, Index i) const {
  const int d = dimension;
  std::vector<double> result(static_cast<std::size_t>(d), 0.0);
  for (int a = 0; a < d; ++a)
    for (int c = 0; c < d; ++c)
      result[a] += frames[(p * d + a) * d + c] * (positions[i * d + c] - positions[p * d + c]);
  return result;
}

std::vector<double> FlatGraph::carried(Index p, Index i, const std::vector<double>& vector) const {
  const int d = dimension;
  std::vector<double> result(static_cast<std::size_t>(d), 0.0);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      for (int c = 0; c < d; ++c) result[a] += frames[(i * d + a) * d + c] * frames[(p * d + b) * d + c] * vector[b];
  return result;
}

namespace {

double box_diagonal(const FlatGraph& g) {
  double squared = 0;
  for (int c = 0; c < g.dimension; ++c) {
    double low = g.positions[c], high = g.positions[c];
    for (Index i = 0; i < g.size(); ++i) {
      low = std::min(low, g.positions[i * g.dimension + c]);
      high = std::max(high, g.positions[i * g.dimension + c]);
    }
    squared += (high - low) * (high - low);
  }
  return std::sqrt(squared);
}

}  // namespace

FlatGraph flat_graph(int d, std::vector<double> positions, const std::vector<Pair>& edges, TransportKind kind,
                     bool reflections, unsigned seed) {
  Random random(seed);
  FlatGraph g;
  g.dimension = d;
  g.positions = std::move(positions);
  const auto n = static_cast<Index>(g.positions.size() / static_cast<std::size_t>(d));
  for (Index i = 0; i < n; ++i) {
    const auto frame = random_frame(d, random, reflections && i % 2 == 1);
    g.frames.insert(g.frames.end(), frame.begin(), frame.end());
  }
  struct Directed {
    Index from, to;
    double weight;
  };
  std::vector<Directed> directed;
  double mean = 0;
  for (const Pair& e : edges) {
    const double w = std::exp(uniform(random, std::log(0.1), std::log(10.0)));
    directed.push_back({e.a, e.b, w});
    directed.push_back({e.b, e.a, w});
  }
  std::stable_sort(directed.begin(), directed.end(),
                   [](const Directed& p, const Directed& q) { return p.from < q.from; });

  CsrGraphData& data = g.data;
  data.dimension = d;
  data.kind = kind;
  data.row_begin.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const Directed& e : directed) {
    ++data.row_begin[e.from + 1];
    data.neighbors.push_back(e.to);
    data.weights.push_back(e.weight);
    const auto log = g.exact(e.from, e.to);
    data.logs.insert(data.logs.end(), log.begin(), log.end());
    mean += std::hypot(log[0], d > 1 ? log[1] : 0.0, d > 2 ? log[2] : 0.0) / static_cast<double>(directed.size());
    // R_ji maps components in frame j (= e.to) to components in frame i (= e.from): F_i F_j^T.
    std::vector<double> R(static_cast<std::size_t>(d) * d, 0.0);
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b)
        for (int c = 0; c < d; ++c)
          R[a * d + b] += g.frames[(e.from * d + a) * d + c] * g.frames[(e.to * d + b) * d + c];
    if (kind == TransportKind::rotation2) R = {R[0], R[2]};
    data.transports.insert(data.transports.end(), R.begin(), R.end());
  }
  for (Index i = 0; i < n; ++i) {
    data.row_begin[i + 1] += data.row_begin[i];
    data.masses.push_back(std::pow(mean, d) * uniform(random, 0.1, 2.0));
  }
  g.diagonal = box_diagonal(g);
  return g;
}

FlatGraph planar_triangulation(Index side, TransportKind kind, bool reflections, unsigned seed) {
  Random random(seed + 1000);
  std::vector<double> positions;
  std::vector<Pair> edges;
  const double h = 1.0 / (side - 1);
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x) {
      const Index i = y * side + x;
      positions.push_back((x + uniform(random, -0.3, 0.3)) * h);
      positions.push_back((y + uniform(random, -0.3, 0.3)) * h);
      if (x + 1 < side) edges.push_back({i, i + 1});
      if (y + 1 < side) edges.push_back({i, i + side});
      if (x + 1 < side && y + 1 < side) edges.push_back(random() % 2 ? Pair{i, i + side + 1} : Pair{i + 1, i + side});
    }
  return flat_graph(2, std::move(positions), edges, kind, reflections, seed);
}

FlatGraph line_graph(Index n) {
  std::vector<double> positions;
  std::vector<Pair> edges;
  for (Index i = 0; i < n; ++i) {
    positions.push_back(i);
    if (i + 1 < n) edges.push_back({i, i + 1});
  }
  return flat_graph(1, std::move(positions), edges, TransportKind::block, true, 3);
}

FlatGraph lattice3(Index side) {
  Random random(5);
  std::vector<double> positions;
  std::vector<Pair> edges;
  const double h = 1.0 / (side - 1);
  for (Index z = 0; z < side; ++z)
    for (Index y = 0; y < side; ++y)
      for (Index x = 0; x < side; ++x) {
        const Index i = (z * side + y) * side + x;
        for (Index c : {x, y, z}) positions.push_back((c + uniform(random, -0.3, 0.3)) * h);
        if (x + 1 < side) edges.push_back({i, i + 1});
        if (y + 1 < side) edges.push_back({i, i + side});
        if (z + 1 < side) edges.push_back({i, i + side * side});
      }
  return flat_graph(3, std::move(positions), edges, TransportKind::block, false, 7);
}

FlatGraph strip(Index length) {
  std::vector<double> positions;
  std::vector<Pair> edges;
  for (Index x = 0; x < length; ++x)
    for (Index y = 0; y < 3; ++y) {
      positions.push_back(x);
      positions.push_back(y);
      if (y + 1 < 3) edges.push_back({x * 3 + y, x * 3 + y + 1});
      if (x + 1 < length) edges.push_back({x * 3 + y, x * 3 + y + 3});
    }
  FlatGraph g = flat_graph(2, std::move(positions), edges, TransportKind::rotation2, false, 9);
  // With equal weights and masses heat decays evenly, so its reach is known.
  std::fill(g.data.weights.begin(), g.data.weights.end(), 1.0);
  std::fill(g.data.masses.begin(), g.data.masses.end(), 1.0);
  return g;
}

CsrGraphData tube(Index rings, Index around) {
  CsrGraphData g;
  g.row_begin.push_back(0);
  for (Index r = 0; r < rings; ++r)
    for (Index k = 0; k < around; ++k) {
      auto edge = [&](Index ring, Index place, double x, double y) {
        if (ring < 0 || ring >= rings) return;
        g.neighbors.push_back(ring * around + (place + around) % around);
        g.weights.push_back(y != 0 && (r == 0 || r == rings - 1) ? 0.5 : 1.0);
        g.logs.insert(g.logs.end(), {x, y});
        g.transports.insert(g.transports.end(), {1, 0});
      };
      edge(r - 1, k, -1, 0);
      edge(r + 1, k, 1, 0);
      edge(r, k - 1, 0, -1);
      edge(r, k + 1, 0, 1);
      g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
      g.masses.push_back(r == 0 || r == rings - 1 ? 0.5 : 1.0);
    }
  return g;
}

}  // namespace ahm::test
