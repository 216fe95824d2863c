/// \file
/// Triangular solves with a supernodal factor.
///
/// The factors of libahm have a small supernode for every few vertices. Loops over one supernode must cost little more than reading it.
#pragma once

#include <span>

#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

inline constexpr Offset max_narrow_columns = 4;

struct SolveGroups;

/// X <- K^-1 X for 1 to `max_narrow_columns` columns, column major; complex vectors as interleaved pairs.
/// @param groups  groups of this factor, processed on several threads; null: one thread
void narrow_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups = nullptr,
                  unsigned threads = 1);

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. The result for a column does not depend
/// on the other columns. Skips supernodes whose rows are zero in the forward solve.
/// @param groups  as in `narrow_solve`
void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns, const SolveGroups* groups = nullptr,
                 unsigned threads = 1);

}  // namespace ahm
