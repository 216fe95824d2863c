/// \file
/// How large the Cholesky factor of a pattern is, and what it takes to compute.
#pragma once

#include "ahm/cholesky/cholesky.hpp"

namespace ahm::bench {

/// What CHOLMOD says of a factor: its entries without padding, and the operations of a real factorization (a complex one
/// takes four times as many).
struct FactorSize {
  double entries, flops;
};

FactorSize factor_size(SparseUpper& pattern, Ordering ordering);

}  // namespace ahm::bench
