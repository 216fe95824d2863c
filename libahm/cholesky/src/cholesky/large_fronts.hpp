/// \file
/// Factorization of large fronts.
#pragma once

#include "ahm/types.hpp"

namespace ahm {

/// Factors the columns of a supernode and computes its update matrix, as `factor_front`.
/// @throws std::bad_alloc
template <int W>
Offset factor_large_front(double* L, Offset rows, Offset columns, double* update, unsigned threads);

}  // namespace ahm
