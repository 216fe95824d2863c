#include "ahm/maps/log_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "heat/check_options.hpp"
#include "maps/affine_heat.hpp"
#include "maps/extrapolate.hpp"
#include "maps/march.hpp"

namespace ahm {
namespace {

/// Sources per block of right-hand sides: as many as 2^24 vertices' worth of memory allows, at most 16. It must not
/// depend on the number of threads, since the block size may change the last bits of a solve.
std::size_t sources_per_block(Index n) {
  return static_cast<std::size_t>(std::clamp<Offset>((Offset{1} << 24) / std::max<Index>(n, 1), 1, 16));
}

/// A map's options, with the solver's where the map has none of its own.
struct MapSettings {
  Variant variant;
  double radius;
  bool frames;
  Progress progress;
};

MapSettings settings_of(const MapOptions& map, const HeatOptions& options) {
  if (!(map.radius > 0))
    throw InvalidArgument("radius is " + detail::number(map.radius) + "; it must be > 0 (infinity: the whole graph)");
  return {map.variant.value_or(options.variant), map.radius, map.frames, map.progress.value_or(options.progress)};
}

void check_options(const HeatOptions& options) {
  if (!(options.accuracy >= 1e-14 && options.accuracy <= 0.1))
    throw InvalidArgument("accuracy is " + detail::number(options.accuracy) + "; it must be in [1e-14, 0.1]");
  if (options.order != 1 && options.order != 2)
    throw InvalidArgument("order is " + std::to_string(options.order) + "; it must be 1 or 2");
  if (options.expected_maps < 0)
    throw InvalidArgument("expected_maps is " + std::to_string(options.expected_maps) + "; it must be >= 0 (0: many)");
}

/// Status of a vertex of the source's component, from its coordinates.
Status status_of(std::span<const double> phi, bool reached, double radius) {
  if (!reached || !all_finite(phi)) return Status::unreached;
  return length(phi) > radius ? Status::beyond_radius : Status::ok;
}

/// One diffusion time.
struct Time {
  HeatOptions options;
  std::once_flag factored;
  std::optional<HeatOperators> operators;
};

}  // namespace

struct LogMapSolver::Impl {
  const TangentGraph& graph;
  HeatOptions options;
  Strategy strategy;
  std::vector<double> factors;  ///< of t_coef, ascending from 1
  mutable std::vector<Time> times;
  mutable std::once_flag numbered;
  mutable Components parts;

  Impl(const TangentGraph& graph, const HeatOptions& options);

  const HeatOperators& operators(std::size_t time) const {
    Time& t = times[time];
    std::call_once(t.factored, [&] {
      if (strategy == Strategy::march) check_memory();
      t.operators.emplace(graph, t.options);
    });
    return *t.operators;
  }
  void check_memory() const;
  std::span<const Index> components() const {
    if (strategy == Strategy::global) return operators(0).components();
    std::call_once(numbered, [&] { parts = connected_components(graph); });
    return parts.of_vertex;
  }

  March front(std::size_t time, const MapSettings& map, unsigned threads) const {
    return March(graph, times[time].options, map.variant, options.accuracy, map.radius, threads, map.progress);
  }
  template <class Values>
  LogMap map_of(const Values& values, Strategy how, const MarchStatistics& march, const Source& source,
                const MapSettings& map, unsigned threads) const;
  LogMap marched(const March& front, const Source& source, const MapSettings& map, unsigned threads) const;
  LogMap finished(const AffineHeat& heat, std::size_t time, std::size_t s, const Source& source,
                  std::span<const double> solution, const MapSettings& map, unsigned threads) const;
  std::vector<LogMap> solve_block(std::size_t time, std::span<const Source> sources, const MapSettings& map,
                                  unsigned threads) const;
  std::vector<LogMap> solve_block(std::span<const Source> sources, const MapSettings& map, unsigned threads) const;
};

LogMapSolver::Impl::Impl(const TangentGraph& graph, const HeatOptions& options)
    : graph(graph),
      options(options),
      strategy(choose_strategy({graph.size(), graph.dimension(), graph.transport_kind()}, options)),
      factors(diffusion_times(options.order, graph)),
      times(factors.size()) {
  if (strategy == Strategy::march) check_heat_options(graph, options);
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k].options = options;
    times[k].options.t_coef *= factors[k];
    times[k].options.check_graph &= k == 0 && strategy == Strategy::global;  // once is enough
    if (strategy == Strategy::global) operators(k);
    times[k].options.progress = {};
  }
}

/// What a march found, vertex by vertex.
class MarchedValues {
 public:
  MarchedValues(const March& front, const Source& source, std::span<const Index> components, double radius)
      : front_(front), components_(source, components), radius_(radius) {}

  Status read(Index vertex, std::span<double> phi) const {
    const auto found = front_.coordinates(vertex);
    std::copy(found.begin(), found.end(), phi.begin());
    if (front_.accepted(vertex)) return status_of(phi, true, radius_);
    if (!components_.hold(vertex)) return Status::disconnected;
    return std::isinf(radius_) ? Status::unreached : Status::beyond_radius;
  }
  void axes(Index vertex, double* out) const { front_.axes(vertex, out); }

 private:
  const March& front_;
  SourceComponents components_;
  double radius_;
};

/// What a global solve found for source number s of a block.
class GlobalValues {
 public:
  GlobalValues(const AffineHeat& heat, std::size_t s, std::span<const double> solution, const Source& source,
               std::span<const Index> components, double radius)
      : heat_(heat),
        s_(s),
        solution_(solution),
        frames_(heat.frames(s)),
        components_(source, components),
        radius_(radius) {}

  Status read(Index vertex, std::span<double> phi) const {
    heat_.coordinates_at(s_, solution_, vertex, phi.data());
    return components_.hold(vertex) ? status_of(phi, heat_.reached(s_, vertex), radius_) : Status::disconnected;
  }
  void axes(Index vertex, double* out) const { frames_.axes(vertex, out); }

 private:
  const AffineHeat& heat_;
  std::size_t s_;
  std::span<const double> solution_;
  FrameField frames_;
  SourceComponents components_;
  double radius_;
};

/// The map that `values` tell of.
template <class Values>
LogMap LogMapSolver::Impl::map_of(const Values& values, Strategy how, const MarchStatistics& march,
                                  const Source& source, const MapSettings& map, unsigned threads) const {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  std::vector<double> coordinates(n * d);
  std::vector<Status> status(n, Status::ok);
  MapExtras extras{march, {}, {}};
  if (map.frames) extras.frames.resize(n * d * d);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    status[i] = values.read(static_cast<Index>(i), phi);
    if (status[i] != Status::ok) std::fill(phi.begin(), phi.end(), NAN);
    if (map.frames) values.axes(static_cast<Index>(i), extras.frames.data() + i * d * d);
  });
  return LogMap(static_cast<int>(d), map.variant, how, source, std::move(coordinates), std::move(status),
                std::move(extras));
}

LogMap LogMapSolver::Impl::marched(const March& front, const Source& source, const MapSettings& map,
                                   unsigned threads) const {
  return map_of(MarchedValues(front, source, components(), map.radius), Strategy::march, front.statistics(), source,
                map, threads);
}

/// Where a global solve leaves vertices beyond its reach, strategy `automatic` marches on.
LogMap LogMapSolver::Impl::finished(const AffineHeat& heat, std::size_t time, std::size_t s, const Source& source,
                                    std::span<const double> solution, const MapSettings& map, unsigned threads) const {
  LogMap result = map_of(GlobalValues(heat, s, solution, source, components(), map.radius), Strategy::global, {},
                         source, map, threads);
  if (options.strategy != Strategy::automatic || result.count(Status::unreached) == 0) return result;
  March on = front(time, map, threads);
  on.run_on(heat, s, solution);
  return marched(on, source, map, threads);
}

/// Solves one block of sources at one diffusion time.
std::vector<LogMap> LogMapSolver::Impl::solve_block(std::size_t time, std::span<const Source> sources,
                                                    const MapSettings& map, unsigned threads) const {
  std::vector<LogMap> maps;
  if (strategy == Strategy::march) {
    for (const Source& source : sources) {
      March on = front(time, map, threads);
      on.run(source);
      maps.push_back(marched(on, source, map, threads));
    }
    return maps;
  }
  AffineHeat heat(graph, operators(time), map.variant, inflow_of(sources, graph, operators(time), map.variant),
                  threads);
  heat.diffuse();
  if (map.progress.stop.stop_requested()) throw Cancelled("cancelled during solve");
  const std::vector<double> solution = heat.solve();
  const std::size_t size = solution.size() / sources.size();
  for (std::size_t s = 0; s < sources.size(); ++s)
    maps.push_back(finished(heat, time, s, sources[s], std::span(solution).subspan(s * size, size), map, threads));
  return maps;
}

/// A marching solver was asked for the factors that it does without: better refused than swapped for.
void LogMapSolver::Impl::check_memory() const {
  const double wanted =
      estimate_cost({graph.size(), graph.dimension(), graph.transport_kind()}, Strategy::global).bytes;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : machine_memory();
  if (memory > 0 && wanted > memory)
    throw ResourceExhausted("this needs the factors of all " + std::to_string(graph.size()) + " vertices, about " +
                            detail::number(std::round(wanted / 1e7) / 100) + " GB of " +
                            detail::number(std::round(memory / 1e7) / 100) +
                            " GB; thin the surface or cut out the part that is wanted");
}

/// The same at all times, extrapolated.
std::vector<LogMap> LogMapSolver::Impl::solve_block(std::span<const Source> sources, const MapSettings& map,
                                                    unsigned threads) const {
  if (factors.size() == 1) return solve_block(0, sources, map, threads);
  MapSettings wider = map;  // the maps of different times differ a little at the radius
  wider.radius += 8 * graph.mean_edge_length() * graph.length_unit();
  std::vector<std::vector<LogMap>> at_times;
  for (std::size_t time = 0; time < factors.size(); ++time) {
    wider.frames = map.frames && time + 2 == factors.size();
    at_times.push_back(solve_block(time, sources, wider, threads));
  }
  std::vector<LogMap> result;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    std::vector<const LogMap*> maps;
    for (const auto& at_time : at_times) maps.push_back(&at_time[s]);
    result.push_back(extrapolate(graph, options.t_coef, factors, maps, map.radius));
  }
  return result;
}

LogMapSolver::LogMapSolver(const TangentGraph& graph, const HeatOptions& options) {
  check_options(options);
  impl_ = std::make_unique<const Impl>(graph, options);
}

LogMapSolver::~LogMapSolver() = default;
LogMapSolver::LogMapSolver(LogMapSolver&&) noexcept = default;
LogMapSolver& LogMapSolver::operator=(LogMapSolver&&) noexcept = default;

const TangentGraph& LogMapSolver::graph() const noexcept { return impl_->graph; }
const HeatOptions& LogMapSolver::options() const noexcept { return impl_->options; }
Strategy LogMapSolver::strategy() const noexcept { return impl_->strategy; }
const HeatOperators& LogMapSolver::operators() const { return impl_->operators(0); }

LogMap LogMapSolver::solve(const Source& source, const MapOptions& options) const {
  return std::move(solve(std::span(&source, 1), options).front());
}

std::vector<LogMap> LogMapSolver::solve(std::span<const Source> sources, const MapOptions& options) const {
  MapSettings settings = settings_of(options, impl_->options);
  const unsigned threads = options.threads.value_or(impl_->options.threads);
  for (const Source& source : sources) check_source(source, impl_->graph);
  const std::size_t block = impl_->strategy == Strategy::global ? sources_per_block(impl_->graph.size()) : 1;
  const auto count = static_cast<Offset>(sources.size());
  // A single block cannot be shared out: its own steps use the threads instead, where that pays.
  const bool single = sources.size() <= block && impl_->graph.size() > 5000;
  const unsigned threads_per_block = single ? detail::thread_count(threads) : 1;

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
