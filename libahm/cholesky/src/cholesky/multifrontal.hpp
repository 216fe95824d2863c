/// \file
/// The dense step of a sparse factorization: the columns of one supernode are eliminated from its front.
#pragma once

#include "ahm/types.hpp"
#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Whether the BLAS takes a front.
constexpr bool is_large_front(Offset rows, Offset columns) { return rows * rows * columns > Offset{1} << 24; }

/// Factors the block of a supernode of real (W = 1) or complex (W = 2) numbers in place, and finds what it takes from the rows
/// below: with the own rows of L first, L <- chol(L), and update <- -L_below L_below^H.
///
/// Small fronts by loops of our own, since the BLAS spends its time on calls and copies there; large ones by LAPACK's.
/// @param L       rows x columns, column major; its upper triangle is left undefined
/// @param update  (rows - columns)^2, column major: the lower triangle is written, the upper one undefined
/// @param threads  that share a large front; the same bits on any number
/// @return the number of pivots that are positive and finite, which is `columns` if all are
/// @throws ResourceExhausted, as `BlasBuffer`, none of which may live on this thread
template <int W>
Offset factor_front(double* L, Offset rows, Offset columns, double* update, unsigned threads = 1);

/// @param values   of L, pattern.numbers() of them, which need not be initialized
/// @param threads  among which groups are shared; the same bits on any number
/// @return the first column, in the order of elimination, whose pivot is not positive and finite; the number of rows if all are
Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads);

}  // namespace ahm
