#include "ahm/log_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include "affine_heat.hpp"
#include "ahm/detail/parallel.hpp"
#include "ahm/detail/text.hpp"
#include "ahm/error.hpp"
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

/// Coordinates and status of one source from its x (adaptive) or Y (localized).
LogMap make_map(const AffineHeat& heat, std::size_t s, const TangentGraph& graph, const Source& source,
                std::span<const double> solution, const MapOptions& options, unsigned threads) {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  std::vector<double> coordinates(n * d);
  std::vector<Status> status(n, Status::ok);
  const std::vector<bool> connected = heat.connected(s);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const auto vertex = static_cast<Index>(i);
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    heat.coordinates_at(options.variant, s, solution, vertex, phi.data());
    if (!connected[i])
      status[i] = Status::component;
    else if (!heat.reached(s, vertex) || !all_finite(phi))
      status[i] = Status::unreached;
    else if (length(phi) > options.radius)
      status[i] = Status::radius;
    if (status[i] != Status::ok) std::fill(phi.begin(), phi.end(), NAN);
  });
  return LogMap(static_cast<int>(d), options.variant, Strategy::global, source, std::move(coordinates),
                std::move(status));
}

/// Solves one block of sources and hands each map to `emit`.
template <class Emit>
void solve_block(const TangentGraph& graph, const HeatOperators& operators, std::span<const Source> sources,
                 const MapOptions& options, unsigned threads, const Emit& emit) {
  AffineHeat heat(graph, operators, inflow_of(sources, graph, operators), threads);
  heat.diffuse();
  if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during solve");
  const std::vector<double> solution = heat.solve(options.variant);
  const std::size_t size = solution.size() / sources.size();
  for (std::size_t s = 0; s < sources.size(); ++s)
    emit(s, make_map(heat, s, graph, sources[s], std::span(solution).subspan(s * size, size), options, threads));
}

}  // namespace

LogMapSolver::LogMapSolver(const TangentGraph& graph, const OperatorOptions& options)
    : graph_(&graph), operators_(graph, options) {}

LogMap LogMapSolver::solve(const Source& source, const MapOptions& options) const {
  return std::move(solve(std::span(&source, 1), options).front());
}

std::vector<LogMap> LogMapSolver::solve(std::span<const Source> sources, const MapOptions& options) const try {
  check_options(options);
  for (const Source& source : sources) check_source(source, *graph_);
  const std::size_t block = sources_per_block(graph_->size());
  const auto count = static_cast<Offset>(sources.size());
  // A single block cannot be shared out: its own steps use the threads instead, where that pays.
  const bool single = sources.size() <= block && graph_->size() > 5000;
  const unsigned threads_per_block = single ? detail::thread_count(options.threads) : 1;

  std::vector<std::optional<LogMap>> maps(sources.size());
  std::mutex report_mutex;
  Offset done = 0;
  options.progress.step("solve", 0.0);
  detail::parallel_chunks(count, static_cast<Offset>(block), options.threads, [&](Offset begin, Offset end) {
    const auto part = sources.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
    solve_block(*graph_, operators_, part, options, threads_per_block,
                [&](std::size_t s, LogMap map) { maps[static_cast<std::size_t>(begin) + s] = std::move(map); });
    std::scoped_lock lock(report_mutex);
    done += end - begin;
    options.progress.step("solve", static_cast<double>(done) / static_cast<double>(count));
  });

  std::vector<LogMap> result;
  result.reserve(maps.size());
  for (auto& map : maps) result.push_back(std::move(*map));
  return result;
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while solving for " + std::to_string(sources.size()) + " log maps on " +
                          std::to_string(graph_->size()) + " vertices");
}

}  // namespace ahm
