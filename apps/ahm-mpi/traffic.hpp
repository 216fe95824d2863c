/// \file
/// What the ranks have told each other.
#pragma once

#include <cstdint>

namespace ahm::tiles::mpi {

/// Of one rank. What PETSc sends is counted from its halos: one vector entry per halo row, product and number.
struct Traffic {
  std::int64_t search_messages = 0, search_bytes = 0;  ///< of choosing bands: crossings, halos, what is forgotten
  std::int64_t solve_messages = 0, solve_bytes = 0;    ///< of products with A and B, and solutions in halos
  std::int64_t reductions = 0;                         ///< of numbers over all ranks
  std::int64_t iterations = 0;                         ///< of conjugate gradients
  std::int64_t solves = 0;
  std::int64_t neighbors = 0;  ///< ranks that own some of the halo of the band at hand
};

}  // namespace ahm::tiles::mpi
