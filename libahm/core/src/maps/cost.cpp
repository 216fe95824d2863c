#include "ahm/maps/cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "heat/check_options.hpp"
#include "heat/component_scales.hpp"
#include "heat/memory_limits.hpp"
#include "maps/front_stars.hpp"
#include "maps/map_work.hpp"
#include "maps/right_hand_side.hpp"

namespace ahm {
namespace {

/// Graphs of at least this many vertices are marched when only one map is wanted (docs/results/march.md has the measurements).
constexpr Index march_from = 50'000, march_volumes_from = 10'000;

/// Nested dissection theory with constants fitted: O(n log n) memory and O(n^1.5) time on surfaces, O(n^(4/3)) and O(n^2)
/// in volumes.
Cost global(double n, int d, double numbers) {
  if (d > 2) return {140 * numbers * std::pow(n, 4.0 / 3.0), 3.4e-10 * numbers * n * n, 3e-7 * numbers * n};
  const double share = numbers / 3;  // 1 real and 1 complex number per entry
  return {share * (92 * n * std::log2(n + 1) + 850 * n), share * (1.2e-6 * n + 1.3e-8 * std::pow(n, 1.5)),
          share * 3e-8 * n * std::log2(n + 1)};
}

/// Linear, but for the band at hand, and on two threads and more the next one's heat.
Cost march(double n, int d, double numbers, bool looks_ahead) {
  const double seconds = (d > 2 ? 1.5e-6 : 2e-6) * numbers * n;
  const double band = d > 2 ? 150 * numbers * std::min(n, 60 * std::pow(n, 2.0 / 3.0))
                            : (looks_ahead ? 6.4e4 : 3.6e4) * numbers * std::min(std::sqrt(n), n / 60);
  return {8 * (numbers + 4 * d + 5) * n + (d > 2 ? 0 : 180 * n) + band, seconds, seconds};
}

/// What follows from counts of one graph. Bytes are those of what is allocated; the rest of bytes is fitted to half of 32 real files
/// and tried on the other half, seconds are fitted to all of them.
class CostOf {
 public:
  explicit CostOf(const TangentGraph& graph)
      : is_complex_(graph.transport_kind() == TransportKind::rotation2),
        is_delaunay_(graph.is_delaunay()),
        d_(graph.dimension()),
        width_(static_cast<double>(graph.transport_layout().width())) {}

  double factor_bytes(const SystemSize& s) const { return 8 * numbers() * s.nonzeros; }
  /// Matrices and their permuted copies, the analysis, vectors.
  double workspace_bytes(const SystemSize& s) const {
    // 64-bit row numbers and values of A and B; B of blocks has a row number for each value.
    const double entry = 16 + (is_complex_ ? 24 : 16 * width_);
    return 1.4 * entry * entries(s) + 500 * s.vertices;
  }
  /// Of the next band, whose heat is found beside the rest of one: the factor of A, matrices, the graph.
  double next_band_bytes(const SystemSize& s) const {
    return factor_bytes(s) / numbers() + 0.5 * workspace_bytes(s) + patch_bytes(s);
  }
  /// Of a band that is cut out.
  double patch_bytes(const SystemSize& s) const { return (12 + 8 * (d_ + width_)) * s.edges; }
  double system_seconds(const SystemSize& s) const {
    // Complex operations are four real ones.
    const double operations = 1 + (is_complex_ ? 4 : std::pow(d_, 3));
    return 1.95e-7 * numbers() * entries(s) + 2.5e-11 * operations * s.operations +
           (is_delaunay_ ? 0 : 6e-7 * s.vertices);
  }
  double solve_seconds(const SystemSize& s) const { return 7e-9 * numbers() * s.nonzeros; }
  /// The front that unfolds distances, four times the work where triangles are halved.
  double front_bytes(double halved) const { return is_delaunay_ ? 1450 * halved : 0; }
  double front_seconds(double reached, double halved) const {
    return is_delaunay_ ? 2e-6 * reached + 3e-6 * std::min(halved, reached) : 0;
  }

 private:
  /// Real ones per entry of the scalar factor, of both.
  double numbers() const { return 1 + width_; }
  double entries(const SystemSize& s) const { return s.edges / 2 + s.vertices; }

  bool is_complex_, is_delaunay_;
  int d_;
  double width_;
};

/// Of the vertices that have a row in the map, and of the program's own columns.
constexpr double row_seconds = 1.2e-6;

}  // namespace

Cost estimate_cost(const TangentGraph& graph, const Source& source, Strategy strategy, const HeatOptions& options,
                   double radius) {
  if (strategy == Strategy::automatic) throw InvalidArgument("estimate_cost: strategy must be global or march");
  if (graph.dimension() != 2)
    throw InvalidArgument("estimate_cost: the graph has dimension " + std::to_string(graph.dimension()) +
                          ", not 2; ask by its size");
  if (!(radius > 0)) throw InvalidArgument("radius is " + detail::number(radius) + "; it must be > 0");
  HeatOptions unchecked = options;
  unchecked.check_graph = false;
  check_heat_options(graph, unchecked);
  check_source(source, graph);
  const ComponentScales scales(graph);
  const CostOf cost(graph);
  const double n = graph.size();
  double halved = 0;
  for (Index size : scales.sizes) halved += size <= most_halved ? size : 0;

  if (strategy == Strategy::global) {
    const SystemSize s = system_size(graph, options);
    const double rest = cost.front_seconds(n, halved) + row_seconds * n;
    return {cost.factor_bytes(s) + 140 * n + cost.workspace_bytes(s) + cost.front_bytes(halved),
            cost.system_seconds(s) + rest, cost.solve_seconds(s) + rest};
  }
  const MarchWork work = march_work(graph, source, ComponentTimes(scales, options.t_coef), radius, options);
  const SystemSize& band = work.largest;
  const bool looks_ahead = detail::thread_count(options.threads) > 1 && std::isinf(radius);
  const double bytes = cost.factor_bytes(band) + cost.workspace_bytes(band) + cost.patch_bytes(band) +
                       (looks_ahead ? cost.next_band_bytes(band) : 0) + 210 * work.reached + 35 * n +
                       cost.front_bytes(halved);
  const double seconds = cost.system_seconds(band) * work.solved / band.vertices +
                         cost.front_seconds(work.reached, halved) + row_seconds * n;
  return {bytes, seconds, seconds};
}

Cost estimate_cost(const GraphSize& size, Strategy strategy, unsigned threads) {
  if (strategy == Strategy::automatic) throw InvalidArgument("estimate_cost: strategy must be global or march");
  const double n = size.vertices;
  // Real numbers per entry of the operators A and B.
  const double numbers = 1.0 + static_cast<double>(TransportLayout{size.kind, size.dimension}.width());
  return strategy == Strategy::global ? global(n, size.dimension, numbers)
                                      : march(n, size.dimension, numbers, detail::thread_count(threads) > 1);
}

Strategy choose_strategy(const GraphSize& size, const HeatOptions& options) {
  if (options.strategy != Strategy::automatic) return options.strategy;
  if (options.expected_maps == 1 && size.vertices >= (size.dimension > 2 ? march_volumes_from : march_from))
    return Strategy::march;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : 0.5 * machine_memory();
  return memory > 0 && estimate_cost(size, Strategy::global).bytes > memory ? Strategy::march : Strategy::global;
}

double machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  const double limit = std::min(resource_limit(), control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
  const double machine = pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : INFINITY;
  const double least = std::min(machine, limit);
  return std::isinf(least) ? 0 : least;
}

}  // namespace ahm
