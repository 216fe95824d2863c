/// \file
/// A and B of a band, its rows shared out over ranks, solved by PETSc.
#pragma once

#include <memory>

#include "ahm-mpi/petsc.hpp"
#include "ahm-mpi/traffic.hpp"
#include "maps/march.hpp"

namespace ahm::tiles::mpi {

/// The residual, relative, that is enough for an accuracy.
double residual_for(double accuracy);

/// By PETSc's conjugate gradients and whatever its options say (`-ksp_type`, `-pc_type`, `-sub_pc_type`, ...).
/// @throws NotPositiveDefinite (no convergence, heat is lost), Error (PETSc)
std::unique_ptr<const HeatSystem> petsc_system(MPI_Comm ranks, BandPart part, const HeatOptions& options,
                                               Traffic& traffic);

}  // namespace ahm::tiles::mpi
