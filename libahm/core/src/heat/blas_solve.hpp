/// \file
/// Solves with a large supernodal factor for many right-hand sides.
#pragma once

#include <span>

#include "heat/supernodal_factor.hpp"

namespace ahm {

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. By the BLAS, supernode by supernode.
void blas_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

}  // namespace ahm
