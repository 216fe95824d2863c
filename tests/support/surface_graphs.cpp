#include "support/surface_graphs.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "support/planar_graphs.hpp"

namespace ahm::test {

CsrGraphData sphere_graph(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Eigen::Vector3d> points, axis_x, axis_y;
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = std::sqrt(1.0 - z * z),
                 turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Eigen::Vector3d p(r * std::cos(turn), r * std::sin(turn), z);
    const Eigen::Vector3d side = p.unitOrthogonal();
    const double angle = 2.0 * std::numbers::pi * uniform(random);
    points.push_back(p);
    axis_x.push_back(std::cos(angle) * side + std::sin(angle) * p.cross(side));
    axis_y.push_back(p.cross(axis_x.back()));
  }
  std::set<std::pair<Index, Index>> edges;
  for (Index i = 0; i < n; ++i) {
    std::vector<Index> order(static_cast<std::size_t>(n));
    for (Index j = 0; j < n; ++j) order[j] = j;
    std::partial_sort(order.begin(), order.begin() + 7, order.end(), [&](Index a, Index b) {
      return (points[a] - points[i]).squaredNorm() < (points[b] - points[i]).squaredNorm();
    });
    for (int k = 1; k < 7; ++k) edges.insert(std::minmax(i, order[k]));
  }
  std::vector<std::vector<std::pair<Index, double>>> rows(static_cast<std::size_t>(n));
  for (const auto& [a, b] : edges) {
    const double w = 0.2 + uniform(random);
    rows[a].push_back({b, w});
    rows[b].push_back({a, w});
  }
  CsrGraphData g;
  g.row_begin = {0};
  for (Index i = 0; i < n; ++i) {
    for (const auto& [j, w] : rows[i]) {
      const Eigen::Vector3d offset = points[j] - points[i];
      g.neighbors.push_back(j);
      g.weights.push_back(w);
      g.logs.push_back(axis_x[i].dot(offset));
      g.logs.push_back(axis_y[i].dot(offset));
      const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(points[j], points[i]).toRotationMatrix();
      const Eigen::Vector3d carried = R * axis_x[j];
      const double c = axis_x[i].dot(carried), s = axis_y[i].dot(carried), r = std::hypot(c, s);
      g.transports.push_back(c / r);
      g.transports.push_back(s / r);
    }
    g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
    g.masses.push_back(4.0 * std::numbers::pi / n * (0.5 + uniform(random)));
  }
  return g;
}

CsrGraphData bent_lattice(Index side, unsigned seed) {
  CsrGraphData g = lattice3(side).data;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(-0.1, 0.1);
  using Block = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  for (Index i = 0; i < static_cast<Index>(g.masses.size()); ++i)
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e) {
      const Index j = g.neighbors[e];
      if (j < i) continue;
      Block R_ji(g.transports.data() + 9 * e);
      R_ji = (Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitX()) *
              Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitZ()))
                 .toRotationMatrix() *
             Eigen::Matrix3d(R_ji);
      Offset back = g.row_begin[j];
      while (g.neighbors[back] != i) ++back;
      Block(g.transports.data() + 9 * back) = Eigen::Matrix3d(R_ji.transpose());
    }
  return g;
}

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

Turned with_frames_turned(const CsrGraphData& g, unsigned seed) {
  const int d = g.dimension;
  const bool rotations = g.kind == TransportKind::rotation2;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::MatrixXd> Q;
  Turned turned{g, {}};
  for (std::size_t i = 0; i < g.masses.size(); ++i) {
    const Eigen::MatrixXd X = Eigen::MatrixXd::NullaryExpr(d, d, [&](auto, auto) { return normal(random); });
    Q.push_back(Eigen::HouseholderQR<Eigen::MatrixXd>(X).householderQ());
    const bool mirror = !rotations && i % 2 == 1;
    if ((Q[i].determinant() < 0) != mirror) Q[i].row(0) *= -1;
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) turned.turns.push_back(Q[i](a, b));
  }
  using RowMajor = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
  for (std::size_t i = 0; i < g.masses.size(); ++i)
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e) {
      const Eigen::MatrixXd& Q_j = Q[g.neighbors[e]];
      Eigen::Map<Eigen::VectorXd> log(turned.data.logs.data() + e * d, d);
      log = (Q[i] * log).eval();
      if (rotations) {
        double* R = turned.data.transports.data() + 2 * e;
        const Eigen::Matrix2d block =
            Q[i] * (Eigen::Matrix2d() << R[0], -R[1], R[1], R[0]).finished() * Q_j.transpose();
        R[0] = block(0, 0), R[1] = block(1, 0);
      } else {
        Eigen::Map<RowMajor> R(turned.data.transports.data() + e * d * d, d, d);
        R = (Q[i] * R * Q_j.transpose()).eval();
      }
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

CsrGraphData relabelled(const CsrGraphData& g, const std::vector<Index>& order) {
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
