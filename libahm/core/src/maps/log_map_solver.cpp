#include "ahm/maps/log_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "cholesky/memory_limits.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/march.hpp"
#include "maps/one_rings.hpp"
#include "maps/solved_values.hpp"
#include "maps/unfolded.hpp"
#include "maps/vertex_row.hpp"

namespace ahm {
namespace {

/// Number of sources per block of right-hand sides, 1 to 16: sources times vertices is at most 2^24 if possible. It must not depend on
/// the number of threads, because the block size may change the last bits of a solve.
std::size_t sources_per_block(Index n) {
  return static_cast<std::size_t>(std::clamp<Offset>((Offset{1} << 24) / std::max<Index>(n, 1), 1, 16));
}

/// Options of a map after the solver's options have replaced missing values.
struct MapSettings {
  Variant variant;
  double radius;
  bool frames, spread, distances;
  Progress progress;
};

MapSettings settings_of(const MapOptions& map, const HeatOptions& options) {
  if (!(map.radius > 0))
    throw InvalidArgument("radius is " + detail::number(map.radius) + "; it must be > 0 (infinity: the whole graph)");
  return {.variant = map.variant.value_or(options.variant),
          .radius = map.radius,
          .frames = map.frames,
          .spread = map.spread && map.distances,
          .distances = map.distances,
          .progress = map.progress.value_or(options.progress)};
}

/// What a march must compute. Within a radius it needs distances, because they determine where it ends.
MarchGoal goal_of(const MapSettings& map) {
  return map.distances || std::isfinite(map.radius) ? MarchGoal::map : MarchGoal::coordinates;
}

}  // namespace

struct LogMapSolver::Impl {
  const TangentGraph& graph;
  HeatOptions options;
  Strategy strategy;
  ComponentScales scales;
  ComponentTimes times;
  mutable std::once_flag factored;
  mutable std::optional<HeatOperators> kept_operators;
  mutable std::once_flag neighborhood_once;
  mutable std::shared_ptr<const Wavefront::OneRings> kept_rings;

  Impl(const TangentGraph& graph, const HeatOptions& options);

  const HeatOperators& operators() const {
    std::call_once(factored, [&] {
      if (strategy == Strategy::march) check_memory_of_factors();
      factor({});
    });
    return *kept_operators;
  }
  void factor(const Progress& progress) const;
  void check_memory_of_factors() const;
  void check_memory_of_maps(std::size_t count, const MapSettings& map) const;
  /// One-rings of the graph, computed at the first call; null on graphs that are not triangulations. With strategy `march` they
  /// contain only the vertices that have midpoints.
  std::shared_ptr<const Wavefront::OneRings> stars(unsigned threads) const {
    if (!graph.is_delaunay()) return nullptr;
    std::call_once(neighborhood_once, [&] {
      std::vector<std::uint8_t> halved = halved_vertices(scales.components.of_vertex, scales.sizes);
      kept_rings =
          std::make_shared<const Wavefront::OneRings>(graph, std::move(halved), strategy == Strategy::global, threads);
    });
    return kept_rings;
  }

  March front(const MapSettings& map, const Unfolded* unfolded, unsigned threads) const {
    const KnownDistances* known = unfolded && !unfolded->distances.empty() ? unfolded : nullptr;
    return March(graph, options, times, map.variant, {map.radius, known}, threads, map.progress, nullptr, nullptr,
                 goal_of(map));
  }
  template <class Values>
  LogMap map_of(const Values& values, Strategy how, const MarchStatistics& march, const Source& source,
                const Unfolded& unfolded, const MapSettings& map, unsigned threads) const;
  LogMap marched(const March& front, const Source& source, const Unfolded& unfolded, const MapSettings& map,
                 unsigned threads) const;
  LogMap finished(AffineHeat& heat, std::size_t s, const Source& source, const Unfolded& unfolded,
                  const MapSettings& map, unsigned threads) const;
  std::vector<LogMap> solve_block(std::span<const Source> sources, const MapSettings& map, unsigned threads) const;
  unsigned threads_for(unsigned requested) const;
};

namespace {

/// @param what  the data that needs the memory, with a plural verb: "... do not fit into memory"
void check_memory(double bytes, double memory, const std::string& what, const std::string& advice) {
  if (!(memory > 0 && bytes > memory)) return;
  throw ResourceExhausted(what + " (about " + detail::gigabytes(bytes) + " of " + detail::gigabytes(memory) + "); " +
                          advice);
}

/// Checks the options and the graph before the first member of `Impl` reads the graph.
const TangentGraph& checked(const TangentGraph& graph, const HeatOptions& options) {
  check_heat_options(graph, options);
  return graph;
}

}  // namespace

LogMapSolver::Impl::Impl(const TangentGraph& graph, const HeatOptions& options)
    : graph(checked(graph, options)),
      options(options),
      strategy(choose_strategy({graph.size(), graph.dimension(), graph.transport_kind()}, options)),
      scales(graph),
      times(scales, options.t_coef) {
  if (strategy == Strategy::global) std::call_once(factored, [&] { factor(options.progress); });
}

void LogMapSolver::Impl::factor(const Progress& progress) const {
  detail::with_memory_check("factoring a graph of " + std::to_string(graph.size()) + " vertices", [&] {
    HeatOptions quiet = options;
    quiet.progress = progress;
    kept_operators = HeatOperatorsAccess::make(
        factored_system(graph, diffusion_times(scales, options.t_coef), quiet.factor()), graph, scales.components);
  });
}

/// Makes a map from solved values.
/// @param unfolded  empty: the distances, if the map has any, are those by heat
template <class Values>
LogMap LogMapSolver::Impl::map_of(const Values& values, Strategy how, const MarchStatistics& march,
                                  const Source& source, const Unfolded& unfolded, const MapSettings& map,
                                  unsigned threads) const {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  const SourceComponents components(source, scales.components.of_vertex);
  std::vector<double> coordinates(n * d);
  std::vector<Status> status(n);
  MapExtras extras;
  extras.march = march;
  if (map.distances) extras.distances.resize(n);
  if (map.spread) extras.spread.resize(n);
  extras.directions = unfolded.directions;
  extras.direction_errors = unfolded.direction_errors;
  extras.nearest = unfolded.nearest;
  extras.radius = map.radius;
  if (map.frames) extras.frames.resize(n * d * d);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const auto vertex = static_cast<Index>(i);
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    const SolvedValue found = values.read(vertex, phi);
    const VertexRow row = vertex_row({phi, found.root_mean_square, found.distance});
    status[i] = !components.hold(vertex)     ? Status::disconnected
                : found.status == Status::ok ? row.status
                                             : found.status;
    if (map.distances) extras.distances[i] = unfolded.distances.empty() ? row.distance : unfolded.distances[i];
    if (!extras.spread.empty()) extras.spread[i] = row.spread;
    if (map.frames) values.axes(vertex, extras.frames.data() + i * d * d);
  });
  if (map.distances && unfolded.distances.empty()) set_source_distances(source, extras.distances);
  for (const auto& [vertex, known] : SourceVertices(source, graph.dimension())) {
    if (known.vector.empty()) continue;
    std::copy(known.vector.begin(), known.vector.end(), coordinates.begin() + static_cast<std::ptrdiff_t>(vertex * d));
    if (!extras.spread.empty()) extras.spread[vertex] = 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    const double distance = map.distances ? extras.distances[i] : length(phi);
    if (status[i] == Status::ok && distance > map.radius) status[i] = Status::beyond_radius;
    if (status[i] == Status::ok) continue;
    std::ranges::fill(phi, NAN);
    if (map.distances) extras.distances[i] = NAN;
    if (!extras.spread.empty()) extras.spread[i] = NAN;
    if (!extras.directions.empty()) extras.directions[2 * i] = extras.directions[2 * i + 1] = NAN;
  }
  return LogMap(static_cast<int>(d), map.variant, how, source, std::move(coordinates), std::move(status),
                std::move(extras));
}

LogMap LogMapSolver::Impl::marched(const March& front, const Source& source, const Unfolded& unfolded,
                                   const MapSettings& map, unsigned threads) const {
  return map_of(MarchedValues(front, map.radius), Strategy::march, front.statistics(), source, unfolded, map, threads);
}

/// Makes a map from a global solve. If vertices are unreached, strategy `automatic` continues by a march.
LogMap LogMapSolver::Impl::finished(AffineHeat& heat, std::size_t s, const Source& source, const Unfolded& unfolded,
                                    const MapSettings& map, unsigned threads) const {
  LogMap result = map_of(GlobalValues(heat, s), Strategy::global, {}, source, unfolded, map, threads);
  if (options.strategy != Strategy::automatic || result.count(Status::unreached) == 0) return result;
  if (goal_of(map) == MarchGoal::map) {
    if (!heat.has_squares()) heat.solve_squares();
    if (!heat.has_lengths() && !graph.is_delaunay()) heat.solve_lengths();
  }
  March on = front(map, &unfolded, threads);
  on.run_on(heat, s, source);
  return marched(on, source, unfolded, map, threads);
}

/// Solves one block of sources.
std::vector<LogMap> LogMapSolver::Impl::solve_block(std::span<const Source> sources, const MapSettings& map,
                                                    unsigned threads) const {
  std::vector<LogMap> maps;
  std::vector<Unfolded> unfolded;  // one per source
  const auto unfold = [&] {
    if (unfolded.empty())
      for (const Source& source : sources)
        unfolded.push_back(map.distances
                               ? unfolded_from(source, graph, stars(threads), map.spread, map.radius, map.progress.stop)
                               : Unfolded{});
  };
  if (strategy == Strategy::march) {
    const bool ends = std::isfinite(map.radius);  // distances determine where, so unfold them first
    if (ends) unfold();
    for (std::size_t s = 0; s < sources.size(); ++s) {
      March on = front(map, ends ? &unfolded[s] : nullptr, threads);
      detail::run_both(
          threads, [&] { on.run(sources[s]); }, unfold);
      maps.push_back(marched(on, sources[s], unfolded[s], map, threads));
    }
    return maps;
  }
  AffineHeat heat(graph, operators(), map.variant, right_hand_side_of(sources, graph, operators(), map.variant),
                  threads);
  const bool lengths = map.distances && std::ranges::any_of(sources, [&](auto& one) { return !unfolds(graph, one); });
  const bool squares = lengths || map.spread;
  const auto solve = [&] {
    heat.diffuse();
    if (map.progress.stop.stop_requested()) throw Cancelled("cancelled during solve");
    heat.solve();
    if (squares) heat.solve_squares();
    if (lengths) heat.solve_lengths();
  };
  detail::run_both(threads, solve, unfold);
  for (std::size_t s = 0; s < sources.size(); ++s)
    maps.push_back(finished(heat, s, sources[s], unfolded[s], map, threads));
  return maps;
}

/// Throws if a solver with strategy `march` is to factor the whole graph and the factors do not fit into memory.
void LogMapSolver::Impl::check_memory_of_factors() const {
  check_memory(estimate_cost({graph.size(), graph.dimension(), graph.transport_kind()}, Strategy::global).bytes,
               options.memory > 0 ? static_cast<double>(options.memory) : machine_memory(),
               "the factors of all " + std::to_string(graph.size()) + " vertices do not fit into memory",
               "simplify the surface or cut out the part of interest");
}

/// Throws if the maps do not fit into memory.
void LogMapSolver::Impl::check_memory_of_maps(std::size_t count, const MapSettings& map) const {
  const auto d = static_cast<double>(graph.dimension());
  const double numbers = d + (map.distances ? 1 : 0) + (map.spread ? 1 : 0) + (map.frames ? d * d : 0);
  check_memory(static_cast<double>(count) * graph.size() * (numbers * sizeof(double) + sizeof(Status)),
               machine_memory(),
               std::to_string(count) + " maps of " + std::to_string(graph.size()) + " vertices do not fit into memory",
               "solve fewer at a time, or use local maps");
}

/// Number of threads to use: 1 if the address space is limited and too small for the additional memory of the threads.
unsigned LogMapSolver::Impl::threads_for(unsigned requested) const {
  const unsigned threads = detail::thread_count(requested);
  const double left = address_space_left();
  if (threads == 1 || std::isinf(left)) return threads;
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  return left < estimate_cost(size, strategy, threads).bytes + threads * bytes_per_thread ? 1 : threads;
}

LogMapSolver::LogMapSolver(const TangentGraph& graph, const HeatOptions& options) {
  impl_ = std::make_unique<const Impl>(graph, options);
}

LogMapSolver::~LogMapSolver() = default;
LogMapSolver::LogMapSolver(LogMapSolver&&) noexcept = default;
LogMapSolver& LogMapSolver::operator=(LogMapSolver&&) noexcept = default;

const TangentGraph& LogMapSolver::graph() const noexcept { return impl_->graph; }
const HeatOptions& LogMapSolver::options() const noexcept { return impl_->options; }
Strategy LogMapSolver::strategy() const noexcept { return impl_->strategy; }
const HeatOperators& LogMapSolver::operators() const { return impl_->operators(); }

LogMap LogMapSolver::solve(const Source& source, const MapOptions& options) const {
  return std::move(solve(std::span(&source, 1), options).front());
}

std::vector<LogMap> LogMapSolver::solve(std::span<const Source> sources, const MapOptions& options) const {
  MapSettings settings = settings_of(options, impl_->options);
  const unsigned threads = impl_->threads_for(options.threads.value_or(impl_->options.threads));
  for (const Source& source : sources) check_source(source, impl_->graph);
  if (sources.size() > 1) impl_->check_memory_of_maps(sources.size(), settings);
  const std::size_t block = impl_->strategy == Strategy::global ? sources_per_block(impl_->graph.size()) : 1;
  const auto count = static_cast<Offset>(sources.size());
  // A single block is not distributed over threads. On larger graphs the steps within the block use the threads instead.
  const bool single = sources.size() <= block && impl_->graph.size() > 5000;
  const unsigned threads_per_block = single ? threads : 1;

  return detail::with_memory_check("solving for log maps", [&] {
    std::vector<std::optional<LogMap>> maps(sources.size());
    std::mutex report_mutex;
    Offset done = 0;
    const Progress progress = settings.progress;
    progress.step("solve", 0.0);
    if (count > 1) settings.progress.report = nullptr;  // the blocks report
    detail::parallel_chunks(count, static_cast<Offset>(block), threads, [&](Offset begin, Offset end) {
      const auto first = static_cast<std::size_t>(begin);
      auto solved = impl_->solve_block(sources.subspan(first, static_cast<std::size_t>(end - begin)), settings,
                                       threads_per_block);
      for (std::size_t s = 0; s < solved.size(); ++s) maps[first + s] = std::move(solved[s]);
      std::scoped_lock lock(report_mutex);
      done += end - begin;
      progress.step("solve", static_cast<double>(done) / static_cast<double>(count));
    });

    std::vector<LogMap> result;
    result.reserve(maps.size());
    for (auto& map : maps) result.push_back(std::move(*map));
    return result;
  });
}

}  // namespace ahm
