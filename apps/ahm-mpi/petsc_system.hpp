/// \file
/// The operators A and B of a band, with rows distributed over ranks, solved by PETSc.
#pragma once

#include <memory>

#include "ahm-mpi/petsc.hpp"
#include "ahm-mpi/traffic.hpp"
#include "maps/march.hpp"

namespace ahm::tiles::mpi {

/// The relative residual that suffices for an accuracy.
double residual_for(double accuracy);

/// Assembles the operators of a band. PETSc solves them with conjugate gradients, or as its options set (`-ksp_type`, `-pc_type`,
/// `-sub_pc_type`, ...).
/// @throws NotPositiveDefinite (no convergence, heat is lost), Error (PETSc)
std::unique_ptr<const HeatSystem> petsc_system(MPI_Comm ranks, BandPart part, const HeatOptions& options,
                                               Traffic& traffic);

}  // namespace ahm::tiles::mpi
