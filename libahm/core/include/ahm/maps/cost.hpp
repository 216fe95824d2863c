/// \file
/// Estimates time and memory of log maps, and chooses the strategy, before anything is computed.
///
/// \code
/// ahm::GraphSize size{.vertices = 10'000'000};
/// ahm::Strategy strategy = ahm::choose_strategy(size, {.expected_maps = 1});
/// ahm::Cost cost = ahm::estimate_cost(size, strategy);
/// std::cout << cost.bytes / 1e9 << " GB, " << cost.first_map_seconds << " s\n";
/// cost = ahm::estimate_cost(graph, ahm::Source::at_vertex(ahm::Vertex{42}), strategy);   // more accurate, needs the graph
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

/// Peak memory without the graph itself, and processor time on a machine of 3 GHz.
struct Cost {
  double bytes = 0;
  double first_map_seconds = 0;  ///< including the factorization
  double next_map_seconds = 0;   ///< for each additional source
};

/// Estimates the cost from the size only. The estimate is within a third for surfaces that are sampled evenly and about as wide as long
/// (docs/results/estimates.md), and within a factor of two for regular volumes. By march, scans of varying density may take twice as much,
/// long tubes half.
/// @param strategy  global or march
/// @param threads   0: one per core. With two or more threads a march stores two bands
/// @throws InvalidArgument (automatic)
Cost estimate_cost(const GraphSize& size, Strategy strategy, unsigned threads = 0);

/// Estimates the cost from the graph, by a symbolic analysis of the matrices: those of the graph, or of the bands of a march, whose
/// extent is computed from shortest edge paths. The estimate is within a third on surfaces (docs/results/estimates.md). It takes a tenth
/// of the time of a map.
///
/// On clouds, where distances are not unfolded, the cost of a march within a radius is uncertain. The march continues while the vectors
/// computed by heat are shorter than the radius, and noise makes them too short. The estimate assumes vectors of the right length. The
/// march never costs more than without a radius.
/// @param options  t_coef, accuracy, ordering, memory; the strategy is that of `strategy`
/// @param radius   radius of a march, world units; > 0
/// @throws InvalidArgument (automatic; d is not 2; a source that does not fit the graph; radius, t_coef, accuracy)
Cost estimate_cost(const TangentGraph& graph, const Source& source, Strategy strategy, const HeatOptions& options = {},
                   double radius = std::numeric_limits<double>::infinity());

/// The strategy of the options. `automatic` becomes `march` for a single map of a large graph, or if the factors would need more than
/// the allowed memory; else, and always with `HeatOptions::solver`, `global`.
Strategy choose_strategy(const GraphSize& size, const HeatOptions& options);

/// Bytes of memory that this process may use: the memory of the machine, or the limit of its control groups (containers) or resource
/// limits (`ulimit`) if that is smaller. 0 if the system does not report it.
double machine_memory();

}  // namespace ahm
