/// \file
/// Products of tall matrices (n rows, a few columns), column major. Sums run over chunks of rows that do not depend on the number of
/// threads. The build has one of two files: tall_products_blas.cpp, or tall_products.cpp by Eigen (AHM_WITH_BLAS).
#pragma once

#include "ahm/types.hpp"

namespace ahm {

/// A chunk of rows of a tall matrix.
struct TallChunk {
  const double* values;  ///< first row of the chunk in column 0
  Offset stride;         ///< numbers from one column to the next
  Offset rows;
};

/// C = A^T B, of `a` and `b` columns.
void transposed_product(const TallChunk& A, Offset a, const TallChunk& B, Offset b, double* C);

/// B += factor A C, of `a` and `b` columns; C is a x b with `stride_C` numbers from one column to the next.
void add_tall_product(const TallChunk& A, Offset a, const double* C, Offset stride_C, double factor, double* B,
                      Offset stride_B, Offset b);

}  // namespace ahm
