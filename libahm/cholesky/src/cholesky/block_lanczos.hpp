/// \file
/// Block Lanczos for the largest eigenvalues of a symmetric operator, with full orthogonalization.
#pragma once

#include <optional>
#include <span>

#include "ahm/cholesky/eigenpairs.hpp"

namespace ahm {

/// Columns of a block: as many as `CholeskyFactor::solve` solves at once.
inline constexpr Offset lanczos_block = 16;

/// The `count` largest eigenvalues of K^-1 in descending order, and their orthonormal eigenvectors.
/// @param solver  solver of K
/// @param n       rows of K
/// @return nothing if the basis would need more than n columns; then a dense method is better
std::optional<Eigenpairs> largest_inverse_eigenpairs(const LinearSolver& solver, Offset n, Offset count,
                                                     unsigned threads, const Progress& progress);

}  // namespace ahm
