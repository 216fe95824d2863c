/// \file
/// Sparse Cholesky factorization: a supernodal multifrontal LL^T of real symmetric and complex Hermitian matrices.
///
/// \code
/// ahm::SparseUpper K;                                      // | 2 -1 |, its upper triangle by columns
/// K.column_begin = {0, 1, 3};                              // | -1 2 |
/// K.rows = {0, 0, 1};
/// K.values = {2, -1, 2};
/// const ahm::SymbolicCholesky symbolic(K);                 // depends on the pattern only
/// const ahm::CholeskyFactor factor(K, symbolic, "K");
/// std::vector<double> x = {1, 0};
/// factor.solve(x, 1);                                      // x = {2/3, 1/3}
/// \endcode
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ahm/cholesky/linear_solver.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Fill-reducing ordering.
enum class Ordering {
  automatic,         ///< `amd`; for large factors also `nested_dissection`, if it needs fewer operations
  amd,               ///< approximate minimum degree [ADD04]: the fastest to compute
  nested_dissection  ///< by patches and smallest separators (docs/concepts/cholesky.md): smaller factors of large matrices
};

struct SupernodalPattern;
struct SupernodalFactor;
struct SymbolicAnalysis;
struct FactorEntry;
template <class Member>
struct EntriesBy;

/// The symbolic analysis of a sparsity pattern: ordering, elimination tree, supernodes.
class SymbolicCholesky {
 public:
  /// @param threads  number of threads; the result does not depend on it
  /// @throws ResourceExhausted
  explicit SymbolicCholesky(const SparseUpper& pattern, Ordering ordering = Ordering::automatic, unsigned threads = 1);
  /// The analysis of a pattern in which every entry of `scalar` is a block of `width` x `width`. Uses the ordering of `scalar`.
  SymbolicCholesky(const SparseUpper& blocks, const SymbolicCholesky& scalar, int width);

  /// Number of entries of the factor.
  Offset nonzeros() const noexcept;
  /// Whether several threads work on one factorization.
  bool is_shared() const noexcept;
  /// Floating-point operations of the factorization of a real matrix.
  double operations() const noexcept;

 private:
  friend class CholeskyFactor;
  explicit SymbolicCholesky(SymbolicAnalysis analysis);

  std::shared_ptr<const SupernodalPattern> pattern_;  ///< shared with the factors
  std::shared_ptr<const EntriesBy<FactorEntry>> entries_;
};

/// A factor K = LL^T. Immutable; `solve` may be called from many threads at once.
class CholeskyFactor final : public LinearSolver {
 public:
  /// Factorizes, and checks that every pivot is finite and positive.
  /// @param name     name of the matrix, for messages
  /// @param threads  number of threads; the result has the same bits for any number
  /// @throws NotPositiveDefinite, ResourceExhausted
  CholeskyFactor(const SparseUpper& matrix, const SymbolicCholesky& symbolic, const char* name, unsigned threads = 1);

  /// X <- K^-1 X, column major; complex vectors as interleaved pairs.
  /// @param threads  number of threads, used for large factors and up to four columns; the result has the same bits for any number
  void solve(std::span<double> X, Offset columns, unsigned threads = 1) const override;

  Offset nonzeros() const noexcept override;
  std::size_t bytes() const noexcept override;

 private:
  SupernodalFactor factor() const;
  void check_pivots(Offset good, const char* name) const;

  std::shared_ptr<const SupernodalPattern> pattern_;
  bool is_complex_;
  std::unique_ptr<const double[]> values_;
};

/// The registers of this processor that factorizations use, for reports: "AVX-512", "AVX2" or "plain".
std::string register_set();

}  // namespace ahm
