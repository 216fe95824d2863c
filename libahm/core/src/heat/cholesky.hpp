/// \file
/// Sparse Cholesky factorization behind a small interface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/types.hpp"
#include "heat/sparse_upper.hpp"
#include "heat/supernodal_pattern.hpp"

namespace ahm {

/// The symbolic analysis of a pattern: fill-reducing ordering, elimination tree, supernodes.
class SymbolicCholesky {
 public:
  /// @throws ResourceExhausted
  SymbolicCholesky(const SparseUpper& pattern, Ordering ordering);
  /// The analysis of the pattern in which every entry of `scalar` is blown up to a block of `width` x `width`, with the
  /// scalar analysis' ordering.
  SymbolicCholesky(const SparseUpper& blocks, const SymbolicCholesky& scalar, int width);

  /// Numbers that the factor will hold.
  Offset nonzeros() const noexcept { return pattern_->numbers(); }
  /// Whether threads share the making of a factor.
  bool is_shared() const noexcept { return pattern_->groups != nullptr; }
  /// Floating-point operations that its making takes, of real numbers.
  double operations() const noexcept { return pattern_->operations; }

 private:
  friend class CholeskyFactor;
  explicit SymbolicCholesky(SymbolicAnalysis analysis);

  std::shared_ptr<const SupernodalPattern> pattern_;  ///< also of the factors
  FactorEntries entries_;
};

/// An LL^T factor. Immutable; `solve` may be called from many threads at once.
class CholeskyFactor {
 public:
  /// Factorizes and checks that every pivot is finite and positive.
  /// @param name     of the operator, for messages
  /// @param threads  that share the work; the same bits on any number
  /// @throws NotPositiveDefinite, ResourceExhausted
  CholeskyFactor(const SparseUpper& matrix, const SymbolicCholesky& symbolic, const char* name, unsigned threads = 1);

  /// X <- K^-1 X, column major; complex vectors as interleaved pairs.
  /// @param threads  that share a large factor among up to `max_narrow_columns` columns; the same bits on any number
  void solve(std::span<double> X, Offset columns, unsigned threads = 1) const;
  /// One column by `solve`, and the check that its residual is small, which a factor passes or not.
  /// @param matrix  K
  /// @throws NotPositiveDefinite
  std::vector<double> checked_solve(const SparseUpper& matrix, std::vector<double> b, const char* name,
                                    unsigned threads = 1) const;
  /// The check alone, by numbers all over [-1, 1).
  void check(const SparseUpper& matrix, const char* name, unsigned threads = 1) const;

  Offset nonzeros() const noexcept { return pattern_->numbers(); }
  std::size_t bytes() const noexcept;

 private:
  SupernodalFactor factor() const { return pattern_->factor(is_complex_, values_.get()); }
  void check_pivots(Offset good, const char* name) const;

  std::shared_ptr<const SupernodalPattern> pattern_;
  bool is_complex_;
  std::unique_ptr<const double[]> values_;
};

}  // namespace ahm
