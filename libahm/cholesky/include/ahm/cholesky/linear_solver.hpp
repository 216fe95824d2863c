/// \file
/// Symmetric matrices and solvers for them: the interface through which another library's factorization replaces `CholeskyFactor`
/// (`HeatOptions::solver`).
///
/// \code
/// class MySolver final : public ahm::LinearSolver { ... };
/// ahm::LogMapSolver solver(graph, {.solver = [](const ahm::SparseUpper& K, const char* name, unsigned threads) {
///                            return std::make_unique<const MySolver>(K, name, threads);
///                          }});
/// \endcode
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// The upper triangle of a symmetric (real) or Hermitian (complex) matrix in compressed columns. Rows of a column ascend without
/// duplicates and include the diagonal. Complex entries are interleaved pairs.
struct SparseUpper {
  bool is_complex = false;
  std::vector<Offset> column_begin;  ///< columns + 1
  std::vector<Offset> rows;
  std::vector<double> values;  ///< 1 number per real entry, 2 per complex entry

  Offset size() const { return static_cast<Offset>(column_begin.size()) - 1; }
};

/// Solves K x = b for one positive definite matrix K. Immutable: all member functions may be called from many threads at once.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// X <- K^-1 X.
  /// @param X        column major; complex vectors as interleaved pairs
  /// @param columns  number of right-hand sides
  /// @param threads  number of threads that the solver may use; the result has the same bits for any number
  /// @throws ResourceExhausted, NotPositiveDefinite (an iterative solver does not converge)
  virtual void solve(std::span<double> X, Offset columns, unsigned threads = 1) const = 0;

  /// Number of stored entries of the factor, for reports.
  virtual Offset nonzeros() const noexcept = 0;
  /// Memory of the solver.
  virtual std::size_t bytes() const noexcept = 0;
};

/// Makes a solver for a matrix, which may be changed afterwards. libahm calls it for one matrix at a time, and checks the residual of
/// one solve.
/// @param name     name of the matrix, for messages
/// @param threads  number of threads that the factorization may use
/// @throws NotPositiveDefinite, ResourceExhausted
using SolverFactory =
    std::function<std::unique_ptr<const LinearSolver>(const SparseUpper& matrix, const char* name, unsigned threads)>;

/// The error for a pivot that is not positive.
/// @param name    name of the matrix
/// @param column  number of columns that were eliminated before the pivot
/// @param size    number of columns of the matrix
NotPositiveDefinite not_positive_definite(const char* name, Offset column, Offset size);

/// Solves for one column and checks that the residual is at most 1e-10, relative.
/// @param matrix  the matrix of the solver
/// @param name    name of the matrix, for messages
/// @return K^-1 b
/// @throws NotPositiveDefinite
std::vector<double> checked_solve(const LinearSolver& solver, const SparseUpper& matrix, std::vector<double> b,
                                  const char* name, unsigned threads = 1);
/// Runs `checked_solve` with a pseudorandom right-hand side in [-1, 1).
void check_residual(const LinearSolver& solver, const SparseUpper& matrix, const char* name, unsigned threads = 1);

}  // namespace ahm
