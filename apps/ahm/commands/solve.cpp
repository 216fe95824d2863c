#include "commands/solve.hpp"

#include <fmt/format.h>

#include <limits>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "cli/system_info.hpp"
#include "input/open.hpp"
#include "output/wording.hpp"

namespace ahm::app {

namespace {

/// Throws if the factors do not fit the memory, instead of letting the machine swap. @throws ResourceExhausted
void check_memory_of_factors(const SolveOptions& options, const TangentGraph& graph) {
  if (options.strategy != Strategy::global) return;
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  const double wanted = estimate_cost(size, Strategy::global).bytes, memory = machine_memory();
  if (memory > 0 && wanted > memory)
    throw ResourceExhausted(fmt::format(
        "--strategy global: the factors require about {}, this machine has {}; use --strategy auto, which chooses the "
        "march",
        bytes_as_text(static_cast<std::int64_t>(wanted)), bytes_as_text(static_cast<std::int64_t>(memory))));
}

/// Checks the memory of a march. The exact estimate takes a tenth of the time of a map, so it is skipped where memory is plentiful.
void check_memory_of_march(const SolveOptions& options, const TangentGraph& graph, const Source& source,
                           Journal& journal) {
  constexpr double worth_a_look = 0.4;
  const double memory = machine_memory();
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  const double quick = estimate_cost(size, Strategy::march, options.threads).bytes;
  if (!(memory > 0 && quick > worth_a_look * memory)) return;
  const double radius = options.radius.value_or(std::numeric_limits<double>::infinity());
  check_memory(
      "the map",
      static_cast<double>(peak_rss_bytes()) + estimate_cost(graph, source, Strategy::march, options, radius).bytes,
      journal);
}

std::string strategy_as_text(const LogMap& map) {
  const MarchStatistics& m = map.march();
  if (map.strategy() == Strategy::global) return "global";
  return fmt::format("march: {}, vertices of the largest band: {}", counted(m.bands, "band"), m.largest_band);
}

}  // namespace

LogMapSolver make_solver(const SolveOptions& options, const TangentGraph& graph, Journal& journal, int maps) {
  check_memory_of_factors(options, graph);
  journal.start("factor");
  HeatOptions heat = options;
  heat.expected_maps = maps;
  heat.progress = journal.progress();
  return LogMapSolver(graph, heat);
}

MapOptions map_options(const SolveOptions& options) {
  MapOptions map;
  if (options.radius) map.radius = *options.radius;
  map.frames = true;
  return map;
}

ExactMapOptions exact_options(const SolveOptions& options, Journal& journal) {
  const MapOptions map = map_options(options);
  return {.radius = map.radius, .frames = map.frames, .progress = journal.progress(), .threads = options.threads};
}

LogMap solve(const SolveOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal) {
  journal.start("solve");
  if (solver.strategy() == Strategy::march) check_memory_of_march(options, solver.graph(), source, journal);
  LogMap map = solver.solve(source, map_options(options));
  journal.add_detail(strategy_as_text(map));
  return map;
}

Maps::Maps(const SolveOptions& options, const Input& input, Journal& journal, int count)
    : exact(exact_options(options, journal)) {
  switch (options.method.value_or(input.surface().suggested_method())) {
    case Method::heat:
      solver.emplace(make_solver(options, input.graph(), journal, count));
      break;
    case Method::polar:
      journal.start("layout");
      polar.emplace(input.surface(), PolarSolverOptions{.threads = options.threads});
      break;
    case Method::exact:
      journal.start("layout");
      geodesics.emplace(input.surface());
      break;
  }
}

LogMap Maps::map(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
                 Journal& journal) const {
  if (solver) return solve(options, *solver, source.source, journal);
  journal.start("solve");
  // The other methods use the same point and u axis as the source.
  const auto u_axis = source.frame ? std::optional(source.frame->x) : std::nullopt;
  if (geodesics) return geodesics->log_map(point_of(input, spec), u_axis, exact_options(options, journal));
  const MapOptions map = map_options(options);
  return polar->log_map(point_of(input, spec), u_axis,
                        {.radius = map.radius, .frames = map.frames, .progress = journal.progress()});
}

LogMap solve(const SolveOptions& options, const Input& input, const SourceSpec& spec, const SurfaceSource& source,
             Journal& journal) {
  return Maps(options, input, journal, 1).map(options, input, spec, source, journal);
}

}  // namespace ahm::app
