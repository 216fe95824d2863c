/// \file
/// Large dense matrices, by the BLAS (large_fronts_blas.cpp) or by loops of our own (large_fronts.cpp). The build has one of the two
/// files (AHM_WITH_BLAS).
#pragma once

#include <span>

#include "ahm/types.hpp"
#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Factors the columns of a supernode, as `factor_front`.
template <int W>
Offset factor_large_front(double* L, Offset rows, Offset columns, double* update, unsigned threads);

}  // namespace ahm
