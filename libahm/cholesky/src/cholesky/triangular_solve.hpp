/// \file
/// Solves with a supernodal factor for few right-hand sides.
///
/// Our factors have one small supernode for every few vertices, so that the BLAS, called four times per supernode, costs more than
/// reading the factor for few right-hand sides; beyond `max_narrow_columns` it is faster.
#pragma once

#include <span>

#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

inline constexpr Offset max_narrow_columns = 4;

struct SolveGroups;

/// X <- K^-1 X for 1 to `max_narrow_columns` columns, column major; complex vectors as interleaved pairs.
/// @param groups  of this factor, which the threads share; null: one after the other
void narrow_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups = nullptr,
                  unsigned threads = 1);

/// Factors of no more numbers lie in the cache of a core, and their supernodes are so small that the BLAS spends its time on
/// calls and copies: `block_solve` takes .4 to .9 of it. Of larger ones, of complex numbers, the BLAS makes more.
inline constexpr Offset most_block_numbers = 1 << 19;

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. Columns do not depend on those
/// beside them, and are not solved for where they are zero.
void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. By the BLAS, supernode by supernode.
void blas_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

}  // namespace ahm
