/// \file
/// The size of the Cholesky factor of a pattern, and the operations of the factorization.
#pragma once

#include "ahm/cholesky/cholesky.hpp"

namespace ahm::bench {

/// CHOLMOD's estimates for a factor: its entries without padding, and the operations of a real factorization. A complex one
/// takes four times as many.
struct FactorSize {
  double entries, flops;
};

FactorSize factor_size(SparseUpper& pattern, Ordering ordering);

}  // namespace ahm::bench
