#include "cholesky/block_lanczos.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"

namespace ahm {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// Largest residual |K^-1 x - mu x| / mu of an accepted eigenvector.
constexpr double residual_tolerance = 1e-11;
constexpr double gain_of_a_block = 5;     ///< about how much one more block reduces the residuals
constexpr Offset blocks_at_once = 64;     ///< blocks of rows per task
constexpr Offset columns_of_panel = 128;  ///< columns of the basis in one piece of memory
constexpr Offset b = lanczos_block;

/// An n x b matrix, column major.
using Block = std::vector<double>;

/// Copies rows of `count` columns to a block of rows, and fills the rest of the block's columns with zeros.
/// @param stride  from one column to the next
void copy_rows(const double* columns, Offset stride, Offset rows, Offset count, double* block) {
  for (Offset c = 0; c < count; ++c)
    std::fill(std::copy_n(columns + c * stride, rows, block + c * block_stride), block + (c + 1) * block_stride, 0.0);
}

/// Orthonormal columns, in panels of memory, and products with them.
class Basis {
 public:
  /// @param panel  columns of a panel, a multiple of the block
  Basis(Offset n, unsigned threads, Offset panel = columns_of_panel) : n_(n), panel_(panel), threads_(threads) {}

  Offset size() const { return size_; }

  void append(const Block& Q) {
    if (size_ % panel_ == 0)
      panels_.push_back(
          std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(blocks() * panel_ * block_stride)));
    size_ += b;
    for_each_block([&](Offset k) { copy_rows(Q.data() + k * block_rows, n_, rows(k), b, at(k, size_ - b)); });
  }

  /// V^T Q for the columns from `first`.
  MatrixXd coefficients(const Block& Q, Offset first = 0) const {
    std::vector<Rows> parts(static_cast<std::size_t>((blocks() + blocks_at_once - 1) / blocks_at_once));
    for_each_block([&](Offset k) {
      Rows& part = parts[static_cast<std::size_t>(k / blocks_at_once)];
      if (part.size() == 0) part = Rows::Zero(size_ - first, b);
      double block[block_rows * b] = {};
      for (Offset c = 0; c < b; ++c)
        for (Offset r = 0; r < rows(k); ++r)
          block[r * b + c] = Q[static_cast<std::size_t>(c * n_ + k * block_rows + r)];
      for_each_panel(first, size_, [&](Offset from, Offset columns) {
        add_transposed_product(at(k, from), columns, block, part.data() + (from - first) * b);
      });
    });
    MatrixXd sum = MatrixXd::Zero(size_ - first, b);
    for (const Rows& part : parts) sum += part;
    return sum;
  }

  /// X += factor V C for the columns from `first`. X is n x C.cols(), column major.
  void add_to(std::span<double> X, const MatrixXd& C, double factor, Offset first = 0) const {
    const Offset groups = (C.cols() + b - 1) / b;
    std::vector<Rows> factors(static_cast<std::size_t>(groups), Rows::Zero(C.rows(), b));
    const auto count = [&](Offset g) { return std::min(b, C.cols() - g * b); };
    for (Offset g = 0; g < groups; ++g) factors[g].leftCols(count(g)) = factor * C.middleCols(g * b, count(g));
    for_each_block([&](Offset k) {
      for (Offset g = 0; g < groups; ++g) {
        double* const own = X.data() + g * b * n_ + k * block_rows;
        double block[b * block_stride] = {};
        copy_rows(own, n_, rows(k), count(g), block);
        for_each_panel(first, first + C.rows(), [&](Offset from, Offset columns) {
          add_product(at(k, from), columns, factors[g].data() + (from - first) * b, block);
        });
        for (Offset a = 0; a < count(g); ++a) std::copy_n(block + a * block_stride, rows(k), own + a * n_);
      }
    });
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, b, Eigen::RowMajor>;

  Offset blocks() const { return (n_ + block_rows - 1) / block_rows; }
  Offset rows(Offset block) const { return std::min(block_rows, n_ - block * block_rows); }
  /// A column in a block of rows. The next columns of the panel follow.
  double* at(Offset block, Offset column) const {
    return panels_[static_cast<std::size_t>(column / panel_)].get() + (block * panel_ + column % panel_) * block_stride;
  }

  /// Calls body(block) for every block of rows, on several threads.
  template <class Body>
  void for_each_block(const Body& body) const {
    detail::parallel_chunks(blocks(), blocks_at_once, threads_, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k) body(k);
    });
  }

  /// Calls body(first column, number of columns) for the columns in [first, last), panel by panel.
  template <class Body>
  void for_each_panel(Offset first, Offset last, const Body& body) const {
    for (Offset column = first; column < last;) {
      const Offset count = std::min(panel_ - column % panel_, last - column);
      body(column, count);
      column += count;
    }
  }

  Offset n_, panel_, size_ = 0;
  unsigned threads_;
  std::vector<std::unique_ptr<double[]>> panels_;
};

/// The basis of the Krylov space of K^-1 and a random block, and K^-1 in this basis.
class BlockLanczos {
 public:
  BlockLanczos(const LinearSolver& solver, Offset n, unsigned threads)
      : solver_(solver), n_(n), threads_(threads), V_(n, threads), Q_(static_cast<std::size_t>(n * b)) {
    for (Offset c = 0; c < b; ++c) fill_randomly(Q_, c);
    orthonormalize(Q_);
    V_.append(Q_);
  }

  /// Multiplies the last block by K^-1 and appends the part that is orthogonal to the basis.
  void step() {
    Block W = std::move(Q_);
    solver_.solve(W, b, threads_);
    const Offset last = V_.size() - b;
    if (last > 0) V_.add_to(W, coupling_.transpose(), -1, last - b);
    const MatrixXd A = V_.coefficients(W, last);
    V_.add_to(W, A, -1, last);
    diagonal_.push_back((A + A.transpose()) / 2);
    coupling_ = orthonormalize(W);
    couplings_.push_back(coupling_);
    Q_ = std::move(W);
    V_.append(Q_);
  }

  /// Columns of the space, without the block that the next step multiplies.
  Offset size() const { return V_.size() - b; }

  /// Eigenpairs in the space.
  struct Ritz {
    VectorXd mu;
    MatrixXd Y;       ///< coordinates of the eigenvectors
    double residual;  ///< the largest, relative to mu
  };

  /// The `count` largest eigenvalues in the space.
  Ritz largest(Offset count) const {
    const Offset m = size();
    MatrixXd T = MatrixXd::Zero(m, m);
    for (Offset j = 0; j * b < m; ++j) {
      T.block(j * b, j * b, b, b) = diagonal_[static_cast<std::size_t>(j)];
      if ((j + 1) * b < m) T.block((j + 1) * b, j * b, b, b) = couplings_[static_cast<std::size_t>(j)];
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(T);  // reads the lower triangle
    Ritz found{solved.eigenvalues().reverse().head(count), solved.eigenvectors().rowwise().reverse().leftCols(count),
               0};
    const VectorXd residuals = (coupling_ * found.Y.bottomRows(b)).colwise().norm();
    found.residual = (residuals.array() / found.mu.array()).maxCoeff();
    return found;
  }

  /// V Y
  std::vector<double> vectors(const MatrixXd& Y) const {
    std::vector<double> X(static_cast<std::size_t>(n_ * Y.cols()), 0.0);
    V_.add_to(X, Y, 1);
    return X;
  }

 private:
  void fill_randomly(Block& Q, Offset column) {
    for (Offset i = 0; i < n_; ++i) Q[static_cast<std::size_t>(column * n_ + i)] = (random_() >> 11) * 0x1p-52 - 1.0;
  }

  /// Replaces W by an orthonormal block Q that is orthogonal to V. Columns that depend on the others are replaced by random ones.
  /// @return R, where W - V V^T W = Q R
  MatrixXd orthonormalize(Block& W) {
    MatrixXd R = normalize(W).R;
    for (int pass = 0; pass < 5; ++pass) {  // "twice is enough", unless random columns came in
      if (V_.size() > 0) V_.add_to(W, V_.coefficients(W), -1);
      const Normalized made = normalize(W);
      R = made.R * R;
      if (made.smallest > 0.5) break;
    }
    return R;
  }

  struct Normalized {
    MatrixXd R;       ///< W = Q R
    double smallest;  ///< smallest eigenvalue of W^T W with unit diagonal; 1 if the columns were orthogonal
  };

  /// Replaces W by an orthonormal block of the same span, by the eigenvectors of W^T W [SW02]. Once it is accurate to the square root of
  /// the precision, twice to the precision.
  Normalized normalize(Block& W) {
    Basis columns(n_, threads_, b);
    columns.append(W);
    const MatrixXd gram = columns.coefficients(W);
    const VectorXd scale = gram.diagonal().unaryExpr([](double g) { return g > 0 ? std::sqrt(g) : 1; });
    const VectorXd inverse = scale.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(inverse.asDiagonal() * gram * inverse.asDiagonal());
    VectorXd lambda = solved.eigenvalues();
    const double smallest = lambda[0];
    MatrixXd forward = MatrixXd::Zero(b, b), R = MatrixXd::Zero(b, b);
    for (Offset c = 0; c < b; ++c) {
      if (lambda[c] < dependent) continue;
      const double root = std::sqrt(lambda[c]);
      forward.col(c) = inverse.asDiagonal() * solved.eigenvectors().col(c) / root;
      R.row(c) = root * solved.eigenvectors().col(c).transpose() * scale.asDiagonal();
    }
    std::fill(W.begin(), W.end(), 0.0);
    columns.add_to(W, forward, 1);
    for (Offset c = 0; c < b; ++c)
      if (lambda[c] < dependent) fill_randomly(W, c);
    return {R, smallest};
  }

  /// Eigenvalues of W^T W with unit diagonal below this are rounding errors.
  static constexpr double dependent = 1e-14;

  const LinearSolver& solver_;
  Offset n_;
  unsigned threads_;
  std::mt19937_64 random_;
  Basis V_;
  Block Q_;
  MatrixXd coupling_;
  std::vector<MatrixXd> diagonal_, couplings_;
};

}  // namespace

std::optional<Eigenpairs> largest_inverse_eigenpairs(const LinearSolver& solver, Offset n, Offset count,
                                                     unsigned threads, const Progress& progress) {
  if (n < 2 * b) return std::nullopt;
  BlockLanczos lanczos(solver, n, threads);
  // Surfaces need 4 count to 5 count columns.
  for (Offset next_check = 7 * count / 2 + 3 * b;;) {
    progress.step("eigenvectors",
                  std::min(0.9, static_cast<double>(lanczos.size()) / static_cast<double>(4 * count + 8 * b)));
    lanczos.step();
    const bool is_last = lanczos.size() + 2 * b > n;
    if (lanczos.size() < next_check && !is_last) continue;
    const auto found = lanczos.largest(count);
    if (found.residual <= residual_tolerance)
      return Eigenpairs{{found.mu.begin(), found.mu.end()}, lanczos.vectors(found.Y)};
    if (is_last || !std::isfinite(found.residual)) return std::nullopt;
    const double blocks = std::log(found.residual / residual_tolerance) / std::log(gain_of_a_block);
    next_check = lanczos.size() + b * std::max<Offset>(1, static_cast<Offset>(std::min(blocks, 1e3)));
  }
}

}  // namespace ahm
