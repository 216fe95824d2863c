/// \file
/// Four numbers at once.
#pragma once

#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// Four real numbers or two complex ones, anywhere in memory. By pointers only: compilers take it of references that they are
/// aligned, and of values in parameters that the processor has registers for them.
using Four [[gnu::vector_size(4 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

[[gnu::always_inline]] inline const Four* four(const double* numbers) { return reinterpret_cast<const Four*>(numbers); }
[[gnu::always_inline]] inline Four* four(double* numbers) { return reinterpret_cast<Four*>(numbers); }

/// Both take K vectors of s.rows numbers, one after the other: own rows first, then those below. Complex numbers (W = 2) are
/// interleaved pairs. With AVX2 and without, the same bits.
template <int W>
struct SupernodeKernels {
  using Kernel = void (*)(const Supernode<W>& s, double* y);
  Kernel forward;   ///< y_own <- L_own^-1 y_own, then y_below <- y_below - L_below y_own
  Kernel backward;  ///< y_own <- L_own^-H (y_own - L_below^H y_below)
};

/// For K = 1 to `max_narrow_columns` vectors, as fast as the processor can.
template <int W, int K>
SupernodeKernels<W> supernode_kernels();

}  // namespace ahm
