/// \file
/// Products of tall matrices (n rows, a few columns). They are stored in blocks of rows, one after another, each column major.
#pragma once

#include <span>

#include "ahm/types.hpp"

namespace ahm {

inline constexpr Offset block_columns = 16;  ///< columns of the matrices B and X below
inline constexpr Offset block_rows = 512;
inline constexpr Offset block_stride = 520;  ///< from one column to the next: an odd number of cache lines, so that columns use all sets

/// C += A^T B for a block of rows.
/// @param A        `columns` columns, a multiple of 4
/// @param B        `block_columns` columns
/// @param C        columns x `block_columns`, column major
/// @param C_stride from one column of C to the next
void add_transposed_product(const double* A, Offset columns, const double* B, double* C, Offset C_stride);

/// X += A C for a block of rows.
/// @param C  columns x `block_columns`, row major
/// @param X  `block_columns` columns
void add_product(const double* A, Offset columns, const double* C, double* X);

}  // namespace ahm
