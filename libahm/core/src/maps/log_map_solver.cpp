#include "ahm/maps/log_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "cholesky/memory_limits.hpp"
#include "maps/affine_heat.hpp"
#include "maps/heat_solvers.hpp"
#include "maps/map_builder.hpp"

namespace ahm {
namespace {

/// Number of sources per block of right-hand sides, 1 to 16: sources times vertices is at most 2^24 if possible. It must not depend on
/// the number of threads, because the block size may change the last bits of a solve.
std::size_t sources_per_block(Index n) {
  return static_cast<std::size_t>(std::clamp<Offset>((Offset{1} << 24) / std::max<Index>(n, 1), 1, 16));
}

/// @param what  the data that needs the memory, with a plural verb: "... do not fit into memory"
void check_memory(double bytes, double memory, const std::string& what, const std::string& advice) {
  if (!(memory > 0 && bytes > memory)) return;
  throw ResourceExhausted(what + " (about " + detail::gigabytes(bytes) + " of " + detail::gigabytes(memory) + "); " +
                          advice);
}

}  // namespace

struct LogMapSolver::Impl {
  Impl(const TangentGraph& graph, const HeatOptions& options)
      : heat_graph(graph, options), global(heat_graph), march(heat_graph) {
    if (heat_graph.strategy == Strategy::global) global.operators(options.progress);
  }

  void check_memory_of_factors() const;
  void check_memory_of_maps(std::size_t count, const MapSettings& map) const;
  unsigned threads_for(unsigned requested) const;

  HeatGraph heat_graph;
  GlobalSolver global;
  MarchSolver march;
};

/// Throws if a solver with strategy `march` is to factor the whole graph and the factors do not fit into memory.
void LogMapSolver::Impl::check_memory_of_factors() const {
  check_memory(estimate_cost(heat_graph.size(), Strategy::global).bytes,
               heat_graph.options.memory > 0 ? static_cast<double>(heat_graph.options.memory) : machine_memory(),
               "the factors of all " + detail::counted(heat_graph.graph.size(), "vertex") + " do not fit into memory",
               "simplify the surface or cut out the part of interest");
}

/// Throws if the maps do not fit into memory.
void LogMapSolver::Impl::check_memory_of_maps(std::size_t count, const MapSettings& map) const {
  const auto d = static_cast<double>(heat_graph.graph.dimension());
  const double numbers = d + (map.distances ? 1 : 0) + (map.spread ? 1 : 0) + (map.frames ? d * d : 0);
  check_memory(static_cast<double>(count) * heat_graph.graph.size() * (numbers * sizeof(double) + sizeof(Status)),
               machine_memory(),
               detail::counted(count, "map") + " of " + detail::counted(heat_graph.graph.size(), "vertex") +
                   " do not fit into memory",
               "solve fewer at a time, or use local maps");
}

/// Number of threads to use: 1 if the address space is limited and too small for the additional memory of the threads.
unsigned LogMapSolver::Impl::threads_for(unsigned requested) const {
  const unsigned threads = detail::thread_count(requested);
  const double left = address_space_left();
  if (threads == 1 || std::isinf(left)) return threads;
  return left < estimate_cost(heat_graph.size(), heat_graph.strategy, threads).bytes + threads * bytes_per_thread
             ? 1
             : threads;
}

LogMapSolver::LogMapSolver(const TangentGraph& graph, const HeatOptions& options) {
  impl_ = std::make_unique<const Impl>(graph, options);
}

LogMapSolver::~LogMapSolver() = default;
LogMapSolver::LogMapSolver(LogMapSolver&&) noexcept = default;
LogMapSolver& LogMapSolver::operator=(LogMapSolver&&) noexcept = default;

const TangentGraph& LogMapSolver::graph() const noexcept { return impl_->heat_graph.graph; }
const HeatOptions& LogMapSolver::options() const noexcept { return impl_->heat_graph.options; }
Strategy LogMapSolver::strategy() const noexcept { return impl_->heat_graph.strategy; }
const HeatOperators& LogMapSolver::operators() const {
  if (impl_->heat_graph.strategy == Strategy::march) impl_->check_memory_of_factors();
  return impl_->global.operators();
}

LogMap LogMapSolver::solve(const Source& source, const MapOptions& options) const {
  return std::move(solve(std::span(&source, 1), options).front());
}

std::vector<LogMap> LogMapSolver::solve(std::span<const Source> sources, const MapOptions& options) const {
  const HeatGraph& heat_graph = impl_->heat_graph;
  const bool is_global = heat_graph.strategy == Strategy::global;
  MapSettings settings(options, heat_graph.options);
  const unsigned threads = impl_->threads_for(options.threads.value_or(heat_graph.options.threads));
  for (const Source& source : sources) check_source(source, heat_graph.graph);
  if (sources.size() > 1) impl_->check_memory_of_maps(sources.size(), settings);
  const std::size_t block = is_global ? sources_per_block(heat_graph.graph.size()) : 1;
  const auto count = static_cast<Offset>(sources.size());
  // A single block is not distributed over threads. On larger graphs the steps within the block use the threads instead.
  const bool single = sources.size() <= block && heat_graph.graph.size() > 5000;
  const unsigned threads_per_block = single ? threads : 1;

  return detail::with_memory_check("solving for log maps", [&] {
    std::vector<std::optional<LogMap>> maps(sources.size());
    detail::Mutex report_mutex;
    Offset done = 0;
    const Progress progress = settings.progress;
    progress.step("solve", 0.0);
    if (count > static_cast<Offset>(block)) heat_graph.prepare_fronts(settings, threads);
    if (count > 1) settings.progress.report = nullptr;  // the blocks report
    detail::parallel_chunks(count, static_cast<Offset>(block), threads, [&](Offset begin, Offset end) {
      const auto first = static_cast<std::size_t>(begin);
      if (is_global) {
        auto solved = impl_->global.solve(sources.subspan(first, static_cast<std::size_t>(end - begin)), settings,
                                          threads_per_block);
        for (std::size_t s = 0; s < solved.size(); ++s) maps[first + s] = std::move(solved[s]);
      } else {
        maps[first] = impl_->march.solve(sources[first], settings, threads_per_block);
      }
      const detail::Lock lock(report_mutex);
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
