/// \file
/// Vectorized kernels of the triangular solves, with four doubles per vector.
#pragma once

#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Four real or two complex numbers at any address. Pass them by pointer only: compilers assume that references are aligned, and that
/// the processor has registers for parameters passed by value.
using Four [[gnu::vector_size(4 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

[[gnu::always_inline]] inline const Four* four(const double* numbers) { return reinterpret_cast<const Four*>(numbers); }
[[gnu::always_inline]] inline Four* four(double* numbers) { return reinterpret_cast<Four*>(numbers); }

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
