/// \file
/// Orders of elimination that leave little fill. ordering.cpp is the only file that knows SuiteSparse: AMD [ADD04], and by
/// CHOLMOD [CDHR08] METIS.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/heat/heat_options.hpp"
#include "heat/sparse_upper.hpp"

namespace ahm {

/// @return which row of the matrix comes first, second, ...
/// @throws ResourceExhausted
std::vector<std::int32_t> elimination_order(const SparseUpper& pattern, Ordering ordering);

}  // namespace ahm
