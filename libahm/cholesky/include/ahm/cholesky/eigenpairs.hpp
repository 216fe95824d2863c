/// \file
/// The smallest eigenvalues of L x = lambda M x and their eigenvectors, e.g. of the Laplacian of a surface.
///
/// \code
/// ahm::SparseUpper L;                                      // the Laplacian of a path of two vertices: |  1 -1 |
/// L.column_begin = {0, 1, 3};                              //                                          | -1  1 |
/// L.rows = {0, 0, 1};
/// L.values = {1, -1, 1};
/// const std::vector<double> masses = {1, 1};
/// const ahm::Eigenpairs found = ahm::smallest_eigenpairs(L, masses, 2);
/// // found.values = {0, 2}, found.vectors = {a, a, a, -a} up to signs, a = sqrt(1/2)
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/cholesky/linear_solver.hpp"
#include "ahm/progress.hpp"

namespace ahm {

/// Eigenvalues and eigenvectors: L x_k = lambda_k M x_k.
struct Eigenpairs {
  std::vector<double> values;   ///< ascending, each as often as its multiplicity
  std::vector<double> vectors;  ///< n x count, column major: x_k^T M x_l = 1 if k = l, otherwise 0
};

/// The `count` smallest eigenvalues of L x = lambda M x with their eigenvectors, by block Lanczos with shift and invert [GLS94].
///
/// Each connected component of L is solved by itself, so that every component contributes its own kernel, and eigenvectors of equal
/// components are not mixed. Components of a few hundred vertices are solved densely. Memory: about five times the result.
/// @param L        real, symmetric, positive semidefinite, n x n
/// @param masses   diagonal of M, n positive numbers
/// @param count    1 to n
/// @param threads  number of threads (0: one per core); the result has the same bits for any number
/// @throws InvalidArgument (L is complex; a number of masses other than n, or one that is not positive and finite; count),
///         NotPositiveDefinite (L has a negative eigenvalue), ResourceExhausted (memory), Cancelled
Eigenpairs smallest_eigenpairs(const SparseUpper& L, std::span<const double> masses, Offset count, unsigned threads = 0,
                               const Progress& progress = {});

}  // namespace ahm
