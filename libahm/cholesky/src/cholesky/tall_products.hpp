/// \file
/// Products of tall matrices (n rows, a few columns). A tall matrix is stored in blocks of rows, one after another.
#pragma once

#include "ahm/types.hpp"

namespace ahm {

inline constexpr Offset block_columns = 16;  ///< columns of the matrices B, C and X below
inline constexpr Offset block_rows = 64;
/// Numbers from one column of a block to the next: an odd number of cache lines, so that the columns use all sets of the caches.
inline constexpr Offset block_stride = 72;

/// C += A^T B for a block of rows.
/// @param A  `columns` columns, a multiple of 8, with `block_stride`
/// @param B  block_rows x block_columns, row major
/// @param C  columns x block_columns, row major
void add_transposed_product(const double* A, Offset columns, const double* B, double* C);

/// X += A C for a block of rows.
/// @param A  `columns` columns with `block_stride`
/// @param C  columns x block_columns, row major
/// @param X  block_columns columns with `block_stride`
void add_product(const double* A, Offset columns, const double* C, double* X);

}  // namespace ahm
