/// \file
/// Vectorized kernels of the triangular solves, with four doubles per vector.
#pragma once

#include "cholesky/registers.hpp"
#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Both kernels take K vectors of s.rows numbers, stored one after another: the supernode's own rows first, then the rows below.
/// Complex numbers (W = 2) are interleaved pairs. The results have the same bits with and without AVX2.
template <int W>
struct SupernodeKernels {
  using Kernel = void (*)(const Supernode<W>& s, double* y);
  Kernel forward;   ///< y_own <- L_own^-1 y_own, then y_below <- y_below - L_below y_own
  Kernel backward;  ///< y_own <- L_own^-H (y_own - L_below^H y_below)
};

/// The kernels for K vectors, 1 <= K <= `max_narrow_columns`. Use AVX2 if the processor has it.
template <int W, int K>
SupernodeKernels<W> supernode_kernels();

}  // namespace ahm
