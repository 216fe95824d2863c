#include "ahm/log_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include "affine_heat.hpp"
#include "ahm/components.hpp"
#include "ahm/detail/memory.hpp"
#include "ahm/detail/parallel.hpp"
#include "ahm/detail/text.hpp"
#include "ahm/error.hpp"
#include "ahm/validate.hpp"
#include "choose_strategy.hpp"
#include "march.hpp"
#include "small_math.hpp"

namespace ahm {
namespace {

/// Sources per block of right-hand sides: as many as 2^24 vertices' worth of memory allows, at most 16. It must not
/// depend on the number of threads, since the block size may change the last bits of a solve.
std::size_t sources_per_block(Index n) {
  return static_cast<std::size_t>(std::clamp<Offset>((Offset{1} << 24) / std::max<Index>(n, 1), 1, 16));
}

void check_options(const MapOptions& options) {
  if (!(options.radius > 0))
    throw InvalidArgument("radius is " + detail::number(options.radius) +
                          "; it must be > 0 (infinity: the whole graph)");
}

void check_options(const SolverOptions& options) {
  if (!(options.accuracy >= 1e-14 && options.accuracy <= 0.1))
    throw InvalidArgument("accuracy is " + detail::number(options.accuracy) + "; it must be in [1e-14, 0.1]");
  if (options.expected_maps < 0)
    throw InvalidArgument("expected_maps is " + std::to_string(options.expected_maps) + "; it must be >= 0 (0: many)");
}

/// Status of a vertex of the source's component, from its coordinates.
Status status_of(std::span<const double> phi, bool reached, double radius) {
  if (!reached || !all_finite(phi)) return Status::unreached;
  return length(phi) > radius ? Status::radius : Status::ok;
}

}  // namespace

struct LogMapSolver::Impl {
  const TangentGraph& graph;
  OperatorOptions operator_options;
  SolverOptions options;
  Strategy strategy;
  mutable std::once_flag factored, numbered;
  mutable std::optional<HeatOperators> factors;
  mutable Components parts;

  const HeatOperators& operators() const {
    std::call_once(factored, [&] { factors.emplace(graph, operator_options); });
    return *factors;
  }
  std::span<const Index> components() const {
    if (strategy == Strategy::global) return operators().components();
    std::call_once(numbered, [&] { parts = connected_components(graph); });
    return parts.of_vertex;
  }

  LogMap march(March&& front, const Source& source, const MapOptions& map) const;
  LogMap march(const Source& source, const MapOptions& map, unsigned threads) const;
  LogMap map_of(const AffineHeat& heat, std::size_t s, const Source& source, std::span<const double> solution,
                const MapOptions& map, unsigned threads) const;
  template <class Emit>
  void solve_block(std::span<const Source> sources, const MapOptions& map, unsigned threads, const Emit& emit) const;
};

/// The result of a march.
LogMap LogMapSolver::Impl::march(March&& front, const Source& source, const MapOptions& map) const {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  std::vector<double> coordinates = std::move(front.coordinates());
  std::vector<Status> status(n, Status::ok);
  std::vector<char> with_source;
  for (std::size_t i = 0; i < n; ++i) {
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    if (front.accepted(static_cast<Index>(i))) {
      status[i] = status_of(phi, true, map.radius);
    } else {
      const auto component = components();
      if (with_source.empty()) {
        with_source.assign(n, 0);
        for (Index k : source.vertices()) with_source[static_cast<std::size_t>(component[k])] = 1;
      }
      status[i] = !with_source[static_cast<std::size_t>(component[i])] ? Status::component
                  : std::isinf(map.radius)                            ? Status::unreached
                                                                      : Status::radius;
    }
    if (status[i] != Status::ok) std::fill(phi.begin(), phi.end(), NAN);
  }
  return LogMap(static_cast<int>(d), map.variant, Strategy::march, source, std::move(coordinates), std::move(status),
                front.statistics());
}

LogMap LogMapSolver::Impl::march(const Source& source, const MapOptions& map, unsigned threads) const {
  March front(graph, operator_options, map.variant, options.accuracy, map.radius, threads, map.progress);
  front.run(source);
  return march(std::move(front), source, map);
}

/// Coordinates and status of one source from its x (adaptive) or Y (localized).
LogMap LogMapSolver::Impl::map_of(const AffineHeat& heat, std::size_t s, const Source& source,
                                  std::span<const double> solution, const MapOptions& map, unsigned threads) const {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  std::vector<double> coordinates(n * d);
  std::vector<Status> status(n, Status::ok);
  const std::vector<bool> connected = heat.connected(s);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const auto vertex = static_cast<Index>(i);
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    heat.coordinates_at(map.variant, s, solution, vertex, phi.data());
    status[i] = connected[i] ? status_of(phi, heat.reached(s, vertex), map.radius) : Status::component;
    if (status[i] != Status::ok) std::fill(phi.begin(), phi.end(), NAN);
  });
  if (options.strategy == Strategy::automatic && std::find(status.begin(), status.end(), Status::unreached) != status.end()) {
    March front(graph, operator_options, map.variant, options.accuracy, map.radius, threads, map.progress);
    front.run_on(heat, s, solution);
    return march(std::move(front), source, map);
  }
  return LogMap(static_cast<int>(d), map.variant, Strategy::global, source, std::move(coordinates), std::move(status));
}

/// Solves one block of sources and hands each map to `emit`.
template <class Emit>
void LogMapSolver::Impl::solve_block(std::span<const Source> sources, const MapOptions& map, unsigned threads,
                                     const Emit& emit) const {
  AffineHeat heat(graph, operators(), inflow_of(sources, graph, operators()), threads);
  heat.diffuse();
  if (map.progress.stop.stop_requested()) throw Cancelled("cancelled during solve");
  const std::vector<double> solution = heat.solve(map.variant);
  const std::size_t size = solution.size() / sources.size();
  for (std::size_t s = 0; s < sources.size(); ++s)
    emit(s, map_of(heat, s, sources[s], std::span(solution).subspan(s * size, size), map, threads));
}

LogMapSolver::LogMapSolver(const TangentGraph& graph, const OperatorOptions& options, const SolverOptions& solver) {
  check_options(solver);
  std::unique_ptr<Impl> impl(new Impl{graph, options, solver, choose_strategy(graph, solver), {}, {}, {}, {}});
  if (impl->strategy == Strategy::global) {
    impl->operators();
  } else {
    check_operator_options(graph, options);
    impl->operator_options.check_graph = false;  // has just been done
  }
  impl->operator_options.progress = {};
  impl_ = std::move(impl);
}

LogMapSolver::~LogMapSolver() = default;
LogMapSolver::LogMapSolver(LogMapSolver&&) noexcept = default;
LogMapSolver& LogMapSolver::operator=(LogMapSolver&&) noexcept = default;

const TangentGraph& LogMapSolver::graph() const noexcept { return impl_->graph; }
Strategy LogMapSolver::strategy() const noexcept { return impl_->strategy; }
const HeatOperators& LogMapSolver::operators() const { return impl_->operators(); }

LogMap LogMapSolver::solve(const Source& source, const MapOptions& options) const {
  return std::move(solve(std::span(&source, 1), options).front());
}

std::vector<LogMap> LogMapSolver::solve(std::span<const Source> sources, const MapOptions& options) const {
  check_options(options);
  for (const Source& source : sources) check_source(source, impl_->graph);
  const bool global = impl_->strategy == Strategy::global;
  const std::size_t block = global ? sources_per_block(impl_->graph.size()) : 1;
  const auto count = static_cast<Offset>(sources.size());
  // A single block cannot be shared out: its own steps use the threads instead, where that pays.
  const bool single = sources.size() <= block && impl_->graph.size() > 5000;
  const unsigned threads_per_block = single ? detail::thread_count(options.threads) : 1;

  return detail::with_memory_check("solving for log maps", [&] {
    std::vector<std::optional<LogMap>> maps(sources.size());
    std::mutex report_mutex;
    Offset done = 0;
    options.progress.step("solve", 0.0);
    MapOptions quiet = options;
    if (count > 1) quiet.progress.report = nullptr;  // the blocks report
    detail::parallel_chunks(count, static_cast<Offset>(block), options.threads, [&](Offset begin, Offset end) {
      const auto first = static_cast<std::size_t>(begin);
      if (global)
        impl_->solve_block(sources.subspan(first, static_cast<std::size_t>(end - begin)), quiet, threads_per_block,
                           [&](std::size_t s, LogMap map) { maps[first + s] = std::move(map); });
      else
        maps[first] = impl_->march(sources[first], quiet, threads_per_block);
      std::scoped_lock lock(report_mutex);
      done += end - begin;
      options.progress.step("solve", static_cast<double>(done) / static_cast<double>(count));
    });

    std::vector<LogMap> result;
    result.reserve(maps.size());
    for (auto& map : maps) result.push_back(std::move(*map));
    return result;
  });
}

}  // namespace ahm
