/// \file
/// The numbers of a Cholesky factor whose supernodes are known, by the multifrontal method [DR83]: each supernode is eliminated from
/// a dense front, which is what the matrix has there and what its children in the elimination tree leave.
#pragma once

#include "heat/supernodal_pattern.hpp"

namespace ahm {

/// @param values   of L, pattern.numbers() of them, which need not be initialized
/// @param threads  among which groups are shared; the same bits on any number
/// @return the first column, in the order of elimination, whose pivot is not positive and finite; the number of rows if all are
Offset factor_by_fronts(const SparseUpper& matrix, const SupernodalPattern& pattern, const FactorEntries& entries,
                        double* values, unsigned threads);

}  // namespace ahm
