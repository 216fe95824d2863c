/// \file
/// Fill-reducing orderings. ordering.cpp is the only file that includes SuiteSparse: AMD [ADD04], and METIS as called by
/// CHOLMOD [CDHR08].
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"

namespace ahm {

/// @return row numbers of the matrix in elimination order
/// @throws ResourceExhausted
std::vector<std::int32_t> elimination_order(const SparseUpper& pattern, Ordering ordering);

}  // namespace ahm
