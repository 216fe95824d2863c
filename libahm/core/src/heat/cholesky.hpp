/// \file
/// Sparse Cholesky factorization behind a small interface; cholesky.cpp is the only file that knows CHOLMOD [CDHR08].
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// The upper triangle of a symmetric (real) or Hermitian (complex) matrix in compressed columns, rows ascending,
/// without duplicates. Complex entries are interleaved pairs.
struct SparseUpper {
  bool is_complex = false;
  std::vector<Offset> column_begin;  ///< columns + 1
  std::vector<Offset> rows;
  std::vector<double> values;  ///< 1 or 2 per entry

  Offset size() const { return static_cast<Offset>(column_begin.size()) - 1; }
};

/// The symbolic analysis of a pattern: fill-reducing ordering, elimination tree, supernodes.
class SymbolicCholesky {
 public:
  /// @throws ResourceExhausted
  SymbolicCholesky(const SparseUpper& pattern, Ordering ordering, bool supernodal);
  /// The analysis of the pattern in which every entry of `scalar` is blown up to a block of `width` x `width`, with the
  /// scalar analysis' ordering.
  SymbolicCholesky(const SparseUpper& blocks, const SymbolicCholesky& scalar, int width);
  ~SymbolicCholesky();
  SymbolicCholesky(SymbolicCholesky&&) noexcept;

  /// Numbers that the factor will hold.
  Offset nonzeros() const noexcept;
  /// Floating-point operations that its making takes, of real numbers.
  double operations() const noexcept;

 private:
  friend class CholeskyFactor;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// An LL^T factor. Immutable; `solve` may be called from many threads at once.
class CholeskyFactor {
 public:
  /// Factorizes and checks the result: every pivot finite and positive, and the residual of one solve small.
  /// @param name     of the operator, for messages
  /// @param threads  that share the work; the same bits on any number
  /// @throws NotPositiveDefinite, ResourceExhausted
  CholeskyFactor(const SparseUpper& matrix, const SymbolicCholesky& symbolic, const char* name, unsigned threads = 1);
  ~CholeskyFactor();
  CholeskyFactor(CholeskyFactor&&) noexcept;

  /// X <- K^-1 X, column major; complex vectors as interleaved pairs.
  /// @param threads  that share a large factor among up to `max_narrow_columns` columns; the same bits on any number
  void solve(std::span<double> X, Offset columns, unsigned threads = 1) const;

  Offset nonzeros() const noexcept;
  std::size_t bytes() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm
