/// \file
/// Triangular solves with a supernodal factor.
///
/// The factors of libahm have a small supernode for every few vertices. For few right-hand sides, four BLAS calls per supernode cost
/// more than reading the factor. For more than `max_narrow_columns` columns the BLAS is faster.
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

/// Largest number of entries of a factor for `block_solve`. Such factors fit into the cache of a core, and their supernodes are so
/// small that the BLAS spends its time on calls and copies: `block_solve` takes 0.4 to 0.9 of the time of `blas_solve`. For larger
/// complex factors the BLAS is faster.
inline constexpr Offset max_block_entries = 1 << 19;

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. The result for a column does not depend
/// on the other columns. Skips supernodes whose rows are zero in the forward solve.
void block_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

/// X <- K^-1 X for any number of columns, column major; complex vectors as interleaved pairs. Calls the BLAS for each supernode.
void blas_solve(const SupernodalFactor& L, std::span<double> X, Offset columns);

}  // namespace ahm
