/// \file
/// Communication between the ranks.
#pragma once

#include <cstdint>

namespace ahm::tiles::mpi {

/// Messages and work of one rank. The traffic of PETSc is computed from the halos: one vector entry per halo row, product and number.
struct Traffic {
  std::int64_t search_messages = 0, search_bytes = 0;  ///< when choosing bands: crossings and halos
  std::int64_t solve_messages = 0, solve_bytes = 0;    ///< for products with A and B, and solutions in halos
  std::int64_t reductions = 0;                         ///< reductions of numbers over all ranks
  std::int64_t iterations = 0;                         ///< iterations of conjugate gradients
  std::int64_t solves = 0;
  std::int64_t neighbors = 0;  ///< ranks that own part of the halo of the current band
};

}  // namespace ahm::tiles::mpi
