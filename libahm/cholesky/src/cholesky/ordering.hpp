/// \file
/// Fill-reducing orderings. ordering.cpp is the only file that includes SuiteSparse: AMD [ADD04], and METIS as called by
/// CHOLMOD [CDHR08]. Without SuiteSparse (AHM_WITH_SUITESPARSE=OFF), ordering_eigen.cpp has Eigen's AMD.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"

namespace ahm {

/// @return row numbers of the matrix in elimination order
/// @throws ResourceExhausted
std::vector<std::int32_t> elimination_order(const SparseUpper& pattern, Ordering ordering);

/// Version of CHOLMOD; without SuiteSparse "none (AMD of Eigen)".
std::string cholmod_version();

}  // namespace ahm
