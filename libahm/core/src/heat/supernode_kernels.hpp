/// \file
/// One supernode of a triangular solve. Supernodes of our factors have some ten columns of some fifty rows, too few for the BLAS;
/// four columns at a time, these loops run at the speed of memory.
///
/// \code
/// const SupernodeKernels<W> kernels = supernode_kernels<W, K>();
/// kernels.forward(s, y);
/// \endcode
#pragma once

#include "heat/supernodal_factor.hpp"

namespace ahm {

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
