/// \file
/// Factorization of the heat operators by SuiteSparse's CHOLMOD, for comparisons with libahm's own Cholesky factorization.
///
/// \code
/// ahm::LogMapSolver solver(graph, {.solver = ahm::cholmod_solver()});
/// \endcode
#pragma once

#include "ahm/cholesky/linear_solver.hpp"

namespace ahm {

/// How CHOLMOD factors a matrix.
enum class CholmodFactorization {
  automatic,  ///< CHOLMOD's choice: supernodal for large factors. The supernodal module is under the GPL
  simplicial  ///< column by column, without a BLAS; uses only modules under the LGPL
};

/// Solvers that use CHOLMOD's LL^T factors [CDHR08] with CHOLMOD's default ordering: minimum degree, or METIS if that is worth trying and
/// gives a smaller factor. Factorization and solves run on one BLAS thread, so results do not depend on the number of threads. To assemble
/// supernodes, Debian's CHOLMOD uses four OpenMP threads, whatever `threads` is; the environment variable OMP_THREAD_LIMIT limits them.
/// The solvers throw `NotPositiveDefinite` and `ResourceExhausted`, as `SolverFactory` requires.
/// @throws InvalidArgument (a build without CHOLMOD, AHM_WITH_CHOLMOD=OFF)
SolverFactory cholmod_solver(CholmodFactorization factorization = CholmodFactorization::automatic);

}  // namespace ahm
