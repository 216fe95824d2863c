#include "ahm/conformance/reference_operator.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <functional>

namespace ahm::test {
namespace {

using Matrix = Eigen::MatrixXd;

Matrix transport(const TangentGraph& graph, const Star& star, std::size_t e) {
  const int d = graph.dimension();
  if (graph.transport_kind() == TransportKind::rotation2) {
    const double c = star.transports[2 * e], s = star.transports[2 * e + 1];
    return (Matrix(2, 2) << c, -s, s, c).finished();
  }
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(star.transports.data() + e * d * d, d, d);
}

/// M + tau L for fibers of `size` numbers. `carry(i, star, e)` is the transport from neighbor e to vertex i.
Eigen::SparseMatrix<double> diffusion(const TangentGraph& graph, double tau, int size,
                                      const std::function<Matrix(Index, const Star&, std::size_t)>& carry) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    double diagonal = graph.mass(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      diagonal += tau * star.weights[e];
      const Matrix block = -tau * star.weights[e] * carry(i, star, e);
      for (int a = 0; a < size; ++a)
        for (int b = 0; b < size; ++b) entries.emplace_back(i * size + a, star.neighbors[e] * size + b, block(a, b));
    }
    for (int a = 0; a < size; ++a) entries.emplace_back(i * size + a, i * size + a, diagonal);
  }
  Eigen::SparseMatrix<double> K(graph.size() * size, graph.size() * size);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// The orthogonal matrix nearest to X, by Newton's iteration.
Matrix polar_factor(Matrix X) {
  X /= X.norm();
  for (int pass = 0; pass < 100; ++pass) {
    const Matrix next = 0.5 * (X + X.inverse().transpose());
    const double step = (next - X).norm();
    X = next;
    if (step < 1e-15) break;
  }
  return X;
}

Matrix solve(const Eigen::SparseMatrix<double>& K, const Matrix& rhs) {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(K);
  return lu.solve(rhs);
}

}  // namespace

std::vector<double> reference_log_map(const TangentGraph& graph, Index source, Variant variant, double t_coef) {
  const int d = graph.dimension();
  const Index n = graph.size();
  const double tau = t_coef * graph.mean_edge_length() * graph.mean_edge_length();

  // Frames: Eq. 11, normalized by the orthogonal polar factor (for d = 2 rotations: division by the modulus).
  Matrix frame_rhs = Matrix::Zero(n * d, d);
  frame_rhs.block(source * d, 0, d, d).setIdentity();
  const Matrix U =
      solve(diffusion(graph, tau, d, [&](Index, const Star& star, std::size_t e) { return transport(graph, star, e); }),
            frame_rhs);
  std::vector<Matrix> frames;
  for (Index i = 0; i < n; ++i) frames.push_back(polar_factor(U.block(i * d, 0, d, d)));

  // The affine system with its homogeneous coordinate: Eq. 10 or Eq. 16.
  auto affine = [&](Index i, const Star& star, std::size_t e) {
    Matrix T = Matrix::Identity(d + 1, d + 1);
    const Eigen::Map<const Eigen::VectorXd> log(star.logs.data() + e * d, d);
    if (variant == Variant::localized) {
      T.topLeftCorner(d, d) = transport(graph, star, e);
      T.topRightCorner(d, 1) = -log;
    } else {
      T.topRightCorner(d, 1) = -frames[i].transpose() * log;
    }
    return T;
  };
  Matrix rhs = Matrix::Zero(n * (d + 1), 1);
  rhs(source * (d + 1) + d) = 1.0;
  const Matrix x = solve(diffusion(graph, tau, d + 1, affine), rhs);

  std::vector<double> phi;
  for (Index i = 0; i < n; ++i) {
    Matrix value = x.block(i * (d + 1), 0, d, 1) / x(i * (d + 1) + d);
    if (variant == Variant::localized) value = frames[i].transpose() * value;
    for (int a = 0; a < d; ++a) phi.push_back(value(a) * graph.length_unit());
  }
  return phi;
}

}  // namespace ahm::test
