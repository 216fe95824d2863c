/// \file
/// Solves with a supernodal factor for many right-hand sides.
#pragma once

#include <span>

#include "heat/triangular_solve.hpp"

namespace ahm {

/// Factors of no more numbers lie in the cache of a core, and their supernodes are so small that the BLAS spends its time on
/// calls and copies: `block_solve` takes .4 to .9 of it. Of larger ones, of complex numbers, the BLAS makes more.
inline constexpr Offset most_block_numbers = 1 << 19;

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. Columns do not depend on those
/// beside them, and are not solved for where they are zero.
void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

}  // namespace ahm
