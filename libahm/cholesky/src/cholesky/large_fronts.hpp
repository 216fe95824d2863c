/// \file
/// Factorization of large fronts: by LAPACK and the BLAS (large_fronts_blas.cpp), or by loops of libahm (large_fronts.cpp). The build
/// has one of the two files (AHM_WITH_BLAS).
#pragma once

#include "ahm/types.hpp"

namespace ahm {

/// Factors the columns of a supernode and computes its update matrix, as `factor_front`.
/// @throws ResourceExhausted
template <int W>
Offset factor_large_front(double* L, Offset rows, Offset columns, double* update, unsigned threads);

}  // namespace ahm
