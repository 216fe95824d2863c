/// \file
/// Conjugate gradients, for matrices whose Cholesky factors would not fit into memory (volumes). Eigen's implementation takes 1.3 to
/// 2.3 times as long (docs/results/march.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/cholesky/linear_solver.hpp"

namespace ahm {

/// Solves K x = b for a real symmetric positive definite K. The preconditioner is symmetric Gauss-Seidel (SSOR) in the order of the
/// unknowns, in Eisenstat's form: with K scaled to I + L + L^T, an iteration is one sweep with I + L^T and one with I + L.
/// Immutable; `solve` may be called from many threads at once.
///
/// Errors are relative to the largest value of x. So, unlike a factorization, this solver loses heat that has decayed by more than
/// the precision of a double. The bands of a march are thin enough to avoid this.
class ConjugateGradient final : public LinearSolver {
 public:
  /// @param name  name of the operator, for messages
  /// @throws NotPositiveDefinite (a diagonal entry is not positive)
  ConjugateGradient(const SparseUpper& matrix, const char* name);

  /// X <- K^-1 X, column major, on the calling thread.
  /// @throws NotPositiveDefinite (a direction of negative energy, or no convergence)
  void solve(std::span<double> X, Offset columns, unsigned threads = 1) const override;

  /// Number of entries above the diagonal.
  Offset nonzeros() const noexcept override { return static_cast<Offset>(values_.size()); }
  std::size_t bytes() const noexcept override { return values_.size() * (sizeof(double) + sizeof(Index)); }

 private:
  void solve(std::span<double> x) const;
  void forward(std::span<double> x) const;   ///< x <- (I + L)^-1 x
  void backward(std::span<double> x) const;  ///< x <- (I + L^T)^-1 x

  const char* name_;
  std::vector<double> scale_;         ///< 1 / sqrt of the diagonal
  std::vector<Offset> column_begin_;  ///< columns of L^T, i.e. rows of L
  std::vector<Index> rows_;
  std::vector<double> values_;
};

}  // namespace ahm
