/// \file
/// Solves with a supernodal factor for few right-hand sides.
///
/// Our factors have one small supernode for every few vertices, so that the BLAS, called four times per supernode, costs more than
/// reading the factor for few right-hand sides; beyond `max_narrow_columns` it is faster.
#pragma once

#include <span>

#include "heat/supernodal_factor.hpp"

namespace ahm {

inline constexpr Offset max_narrow_columns = 4;

struct SolveGroups;

/// X <- K^-1 X for 1 to `max_narrow_columns` columns, column major; complex vectors as interleaved pairs.
/// @param groups  of this factor, which the threads share; null: one after the other
void narrow_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups = nullptr,
                  unsigned threads = 1);

}  // namespace ahm
