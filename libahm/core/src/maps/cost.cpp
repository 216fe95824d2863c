#include "maps/cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "cholesky/memory_limits.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/one_rings.hpp"

namespace ahm {
namespace {

/// Typical ratio of the length of an edge path to the distance, in directions that do not follow edges.
constexpr double detour = 1.1;

constexpr double unreached = std::numeric_limits<double>::infinity();

/// Length of the shortest edge path from the source to each vertex; `unreached` if there is no path, or none up to `farthest`.
/// @param length_of  length_of(vertex, star, edge): length of an edge
template <class LengthOf>
std::vector<double> ways_from(const Source& source, const TangentGraph& graph, double farthest,
                              const LengthOf& length_of) {
  std::vector<double> known(static_cast<std::size_t>(graph.size()), unreached);
  ShortestPaths<double, std::vector<double>> paths(known, unreached);
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) paths.offer(source.vertices()[k].index, 0);
  paths.run([&](Index i, double so_far) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0)
        if (const double way = so_far + length_of(i, star, e); way <= farthest) paths.offer(star.neighbors[e], way);
  });
  return known;
}

}  // namespace

SystemSize system_size(const TangentGraph& graph, std::span<const Index> vertices, const HeatOptions& options) {
  std::vector<Index> place(static_cast<std::size_t>(graph.size()), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) place[vertices[k]] = static_cast<Index>(k);
  SystemSize size{.vertices = static_cast<double>(vertices.size())};
  SparseUpper pattern;
  pattern.column_begin.push_back(0);
  std::vector<Index> above;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Star star = graph.star(vertices[k]);
    above.clear();
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = place[star.neighbors[e]];
      if (j < 0 || star.weights[e] == 0) continue;
      size.edges += 1;
      if (j < static_cast<Index>(k)) above.push_back(j);
    }
    std::sort(above.begin(), above.end());
    above.erase(std::unique(above.begin(), above.end()), above.end());
    pattern.rows.insert(pattern.rows.end(), above.begin(), above.end());
    pattern.rows.push_back(static_cast<Offset>(k));
    pattern.column_begin.push_back(static_cast<Offset>(pattern.rows.size()));
  }
  const SymbolicCholesky analysis(pattern, options.ordering, options.threads);
  size.nonzeros = static_cast<double>(analysis.nonzeros());
  size.operations = analysis.operations();
  return size;
}

SystemSize system_size(const TangentGraph& graph, const HeatOptions& options) {
  std::vector<Index> all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  return system_size(graph, all, options);
}

MarchWork march_work(const TangentGraph& graph, const Source& source, const MarchScales& scales, double radius,
                     const HeatOptions& options) {
  const auto heat_way = [&](Index i, const Star& star, std::size_t e) {
    const double tau = scales.tau(i);
    return std::max(0.0, edge_heat_distance(length(star.log(e)), star.weights[e], tau, std::sqrt(tau),
                                            [&] { return heat_diagonal(graph, i, tau); }));
  };
  const std::vector<double> levels = ways_from(source, graph, std::numeric_limits<double>::max(), heat_way);
  double last = 0, farthest = 0;  // heat distance of the end of the march, and of the farthest vertex
  for (double level : levels)
    if (level < unreached) farthest = std::max(farthest, level);
  if (std::isinf(radius)) {
    last = farthest;
  } else {
    const Index start = source.vertices()[0].index;
    const double reach = detour * (radius / graph.length_unit() + 4 * scales.h(start));
    const auto ways =
        ways_from(source, graph, reach, [](Index, const Star& star, std::size_t e) { return length(star.log(e)); });
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i] < unreached) last = std::max(last, levels[i]);
  }

  MarchWork work;
  std::vector<double> sorted;
  for (double level : levels)
    if (level < unreached) sorted.push_back(level);
  std::sort(sorted.begin(), sorted.end());
  const auto count_to = [&](double level) {
    return static_cast<double>(std::upper_bound(sorted.begin(), sorted.end(), level) - sorted.begin());
  };
  const double margin = march_margin(options.accuracy), depth = march_step + margin, step = depth / detour - margin;
  double largest_from = 0;
  for (double from = 0; from <= last; from += step) {
    const double ahead = count_to(from + depth), size = ahead - (from > 0 ? count_to(from) : 0);
    ++work.bands;
    work.solved += size;
    work.reached = ahead;
    if (size > work.largest.vertices) work.largest.vertices = size, largest_from = from;
    if (from + depth >= farthest) break;  // this band contains all remaining vertices
  }
  std::vector<Index> band;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if ((levels[i] > largest_from || largest_from == 0) && levels[i] <= largest_from + depth)
      band.push_back(static_cast<Index>(i));
  work.largest = system_size(graph, band, options);
  return work;
}

namespace {

/// The number of vertices from which a single map is computed by a march (measurements: docs/results/march.md).
constexpr Index march_from = 50'000, march_volumes_from = 10'000;

/// Cost of a global solve, by the theory of nested dissection with fitted constants: O(n log n) memory and O(n^1.5) time on surfaces,
/// O(n^(4/3)) memory and O(n^2) time in volumes.
Cost global(double n, int d, double numbers) {
  if (d > 2) return {140 * numbers * std::pow(n, 4.0 / 3.0), 3.4e-10 * numbers * n * n, 3e-7 * numbers * n};
  const double share = numbers / 3;  // 1 real and 1 complex number per entry
  return {share * (92 * n * std::log2(n + 1) + 850 * n), share * (1.2e-6 * n + 1.3e-8 * std::pow(n, 1.5)),
          share * 3e-8 * n * std::log2(n + 1)};
}

/// Cost of a march: linear in n, plus the memory of the current band and, with two or more threads, of the next band's heat.
Cost march(double n, int d, double numbers, bool looks_ahead) {
  const double seconds = (d > 2 ? 1.5e-6 : 2e-6) * numbers * n;
  const double band = d > 2 ? 150 * numbers * std::min(n, 60 * std::pow(n, 2.0 / 3.0))
                            : (looks_ahead ? 6.4e4 : 3.6e4) * numbers * std::min(std::sqrt(n), n / 60);
  return {8 * (numbers + 4 * d + 5) * n + (d > 2 ? 0 : 180 * n) + band, seconds, seconds};
}

/// Computes bytes and seconds from the counts of one graph. Bytes are computed from the allocations; the constants for the rest are fitted
/// to half of 32 real files and validated on the other half. The constants for seconds are fitted to all files.
class CostOf {
 public:
  explicit CostOf(const TangentGraph& graph)
      : is_complex_(graph.transport_kind() == TransportKind::rotation2),
        is_delaunay_(graph.is_delaunay()),
        d_(graph.dimension()),
        width_(static_cast<double>(graph.transport_layout().width())) {}

  double factor_bytes(const SystemSize& s) const { return 8 * numbers() * s.nonzeros; }
  /// Bytes of the matrices and their permuted copies, the symbolic analysis, and vectors.
  double workspace_bytes(const SystemSize& s) const {
    // 64-bit row numbers and values of A and B. In block graphs B has a row number for each value.
    const double entry = 16 + (is_complex_ ? 24 : 16 * width_);
    return 1.4 * entry * entries(s) + 500 * s.vertices;
  }
  /// Bytes of the next band, whose heat is computed at the same time as the other values of the current band: the factor of A, matrices,
  /// the graph.
  double next_band_bytes(const SystemSize& s) const {
    return factor_bytes(s) / numbers() + 0.5 * workspace_bytes(s) + patch_bytes(s);
  }
  /// Bytes of the subgraph of a band.
  double patch_bytes(const SystemSize& s) const { return (12 + 8 * (d_ + width_)) * s.edges; }
  double system_seconds(const SystemSize& s) const {
    // A complex operation costs four real ones.
    const double operations = 1 + (is_complex_ ? 4 : std::pow(d_, 3));
    return 1.95e-7 * numbers() * entries(s) + 2.5e-11 * operations * s.operations +
           (is_delaunay_ ? 0 : 6e-7 * s.vertices);
  }
  double solve_seconds(const SystemSize& s) const { return 7e-9 * numbers() * s.nonzeros; }
  /// Bytes of the wavefront. @param halved  number of vertices of components whose edges have midpoints
  double front_bytes(double halved) const { return is_delaunay_ ? 1450 * halved : 0; }
  double front_seconds(double reached, double halved) const {
    return is_delaunay_ ? 2e-6 * reached + 3e-6 * std::min(halved, reached) : 0;
  }

 private:
  /// Real numbers in both factors per entry of the scalar factor.
  double numbers() const { return 1 + width_; }
  double entries(const SystemSize& s) const { return s.edges / 2 + s.vertices; }

  bool is_complex_, is_delaunay_;
  int d_;
  double width_;
};

/// Seconds per row of the map, including the columns of the program's output.
constexpr double row_seconds = 1.2e-6;

}  // namespace

Cost estimate_cost(const TangentGraph& graph, const Source& source, Strategy strategy, const HeatOptions& options,
                   double radius) {
  if (strategy == Strategy::automatic) throw InvalidArgument("estimate_cost: strategy must be global or march");
  if (graph.dimension() != 2)
    throw InvalidArgument("estimate_cost: the graph has dimension " + std::to_string(graph.dimension()) +
                          ", not 2; use the overload that takes a GraphSize");
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
  if (options.solver) return Strategy::global;
  if (options.expected_maps == 1 && size.vertices >= (size.dimension > 2 ? march_volumes_from : march_from))
    return Strategy::march;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : 0.5 * machine_memory();
  return memory > 0 && estimate_cost(size, Strategy::global).bytes > memory ? Strategy::march : Strategy::global;
}

double machine_memory() {
  const double limit = std::min(resource_limit(), control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
  const double least = std::min(physical_memory(), limit);
  return std::isinf(least) ? 0 : least;
}

}  // namespace ahm
