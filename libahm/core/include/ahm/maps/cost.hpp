/// \file
/// What maps will cost, and which strategy suits, before anything is computed.
///
/// \code
/// ahm::GraphSize size{.vertices = 10'000'000};
/// ahm::Strategy strategy = ahm::choose_strategy(size, {.expected_maps = 1});
/// ahm::Cost cost = ahm::estimate_cost(size, strategy);
/// std::cout << cost.bytes / 1e9 << " GB, " << cost.first_map_seconds << " s\n";
/// \endcode
#pragma once

#include "ahm/maps/log_map_solver.hpp"

namespace ahm {

struct GraphSize {
  Index vertices = 0;
  int dimension = 2;
  TransportKind kind = TransportKind::rotation2;
};

/// Bytes at the peak besides the graph itself, and seconds.
struct Cost {
  double bytes = 0;
  double first_map_seconds = 0;  ///< factorization included
  double next_map_seconds = 0;   ///< for each further source
};

/// From the size alone: fits to measurements on surfaces (good to a third, docs/march.md) and regular volumes (to a factor of
/// two), on one core of a 3 GHz machine with an optimized BLAS.
/// @param strategy  global or march
/// @param order     of the maps, 1 or 2: two times a map's diffusion times of order 1 and more (`HeatOptions::order`)
/// @throws InvalidArgument (automatic)
Cost estimate_cost(const GraphSize& size, Strategy strategy, int order = 1);

/// The strategy itself, or for `automatic`: `march` for a single map of a large graph, and wherever the factors would
/// need more than the allowed memory; else `global`.
Strategy choose_strategy(const GraphSize& size, const HeatOptions& options);

/// Bytes of memory this process may take: what the machine has, or less where its control groups (containers) or its
/// resource limits (`ulimit`) allow less; 0 when the system does not say.
double machine_memory();

}  // namespace ahm
