/// \file
/// What maps will cost, and which strategy suits, before anything is computed.
///
/// \code
/// ahm::GraphSize size{.vertices = 10'000'000};
/// ahm::Strategy strategy = ahm::choose_strategy(size, {.expected_maps = 1});
/// ahm::Cost cost = ahm::estimate_cost(size, strategy);
/// std::cout << cost.bytes / 1e9 << " GB, " << cost.first_map_seconds << " s\n";
/// cost = ahm::estimate_cost(graph, ahm::Source::at_vertex(ahm::Vertex{42}), strategy);   // nearer, once there is a graph
/// \endcode
#pragma once

#include <limits>

#include "ahm/maps/log_map_solver.hpp"

namespace ahm {

struct GraphSize {
  Index vertices = 0;
  int dimension = 2;
  TransportKind kind = TransportKind::rotation2;
};

/// Bytes at the peak besides the graph itself, and seconds of processor time, on a machine of 3 GHz with an optimized BLAS.
struct Cost {
  double bytes = 0;
  double first_map_seconds = 0;  ///< factorization included
  double next_map_seconds = 0;   ///< for each further source
};

/// From the size alone: of surfaces that are sampled evenly and as wide as long (good to a third, docs/results/estimates.md) and of regular
/// volumes (to a factor of two). Scans whose density varies may take twice that by march, long tubes half.
/// @param strategy  global or march
/// @param threads   a march on two and more holds two bands; 0: one per core
/// @throws InvalidArgument (automatic)
Cost estimate_cost(const GraphSize& size, Strategy strategy, unsigned threads = 0);

/// From the graph: by the symbolic analysis of what is factored, which is the graph or the bands of a march; these are cut by
/// the lengths of the shortest edge paths from the source. Good to a third on surfaces (docs/results/estimates.md), in a tenth of a map's time.
///
/// What a march within a radius takes where distances are not unfolded (clouds) cannot be known before: it goes on wherever vectors
/// of heat are shorter than the radius, and in noise they are too short. This tells what it takes where they are not; it takes at
/// most what it takes without a radius.
/// @param options  t_coef, accuracy, ordering, kind of factorization
/// @param radius   of a march, world units; > 0
/// @throws InvalidArgument (automatic; d is not 2; a source that does not fit the graph; radius, t_coef, accuracy)
Cost estimate_cost(const TangentGraph& graph, const Source& source, Strategy strategy, const HeatOptions& options = {},
                   double radius = std::numeric_limits<double>::infinity());

/// The strategy itself, or for `automatic`: `march` for a single map of a large graph, and wherever the factors would
/// need more than the allowed memory; else `global`.
Strategy choose_strategy(const GraphSize& size, const HeatOptions& options);

/// Bytes of memory this process may take: what the machine has, or less where its control groups (containers) or its
/// resource limits (`ulimit`) allow less; 0 when the system does not say.
double machine_memory();

}  // namespace ahm
