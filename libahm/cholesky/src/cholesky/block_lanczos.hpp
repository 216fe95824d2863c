/// \file
/// Block Lanczos for the largest eigenvalues of a symmetric operator, with full orthogonalization.
#pragma once

#include <optional>
#include <span>

#include "ahm/cholesky/eigenpairs.hpp"
#include "cholesky/tall_products.hpp"

namespace ahm {

/// Columns of a block. `CholeskyFactor::solve` solves as many at once.
inline constexpr Offset lanczos_block = block_columns;

/// The `count` largest eigenvalues of K^-1 in descending order, and their orthonormal eigenvectors.
/// @param solver  solver of K
/// @param n       rows of K
/// @return nothing if the basis would need more than n columns; then a dense method is better
std::optional<Eigenpairs> largest_inverse_eigenpairs(const LinearSolver& solver, Offset n, Offset count,
                                                     unsigned threads, const Progress& progress);

}  // namespace ahm
