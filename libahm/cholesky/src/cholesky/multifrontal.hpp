/// \file
/// Multifrontal factorization [DR83]: each supernode is eliminated in a dense matrix, its front.
#pragma once

#include "ahm/types.hpp"
#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Whether a front is large enough for `factor_large_front`.
constexpr bool is_large_front(Offset rows, Offset columns) { return rows * rows * columns > Offset{1} << 24; }

/// Factors the columns of a supernode in place, L <- chol(L), and computes its update matrix, update <- -L_below L_below^H. The first
/// `columns` rows of L are the supernode's own rows, the others are L_below. Real (W = 1) or complex (W = 2).
///
/// Large fronts are factored by `factor_large_front`. In small fronts its copies would cost more than they save.
/// @param L       rows x columns, column major; its upper triangle is left undefined
/// @param update  (rows - columns)^2, column major; only the lower triangle is defined
/// @param threads  threads that share a large front; the result has the same bits for any number
/// @return number of columns before the first pivot that is not positive and finite; `columns` if there is none
/// @throws std::bad_alloc
template <int W>
Offset factor_front(double* L, Offset rows, Offset columns, double* update, unsigned threads = 1);

/// Factors a matrix.
/// @param values   out: pattern.numbers() entries of L; need not be initialized
/// @param threads  threads that share the groups of the pattern; the result has the same bits for any number
/// @return the first column, in elimination order, whose pivot is not positive and finite; the number of rows if there is none
Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads);

}  // namespace ahm
