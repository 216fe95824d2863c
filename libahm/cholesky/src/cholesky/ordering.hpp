/// \file
/// Fill-reducing orderings.
#pragma once

#include "ahm/cholesky/cholesky.hpp"
#include "cholesky/supernodal_pattern.hpp"

namespace ahm {

/// The symbolic analysis of a matrix, ordered.
/// @throws ResourceExhausted
SymbolicAnalysis ordered_analysis(const SparseUpper& pattern, Ordering ordering, unsigned threads);

}  // namespace ahm
