// From factors to maps: the whole map and its share outside the triangular solves, the march, the quality of a map.
#include <benchmark/benchmark.h>

#include <optional>

#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "graphs.hpp"
#include "machine.hpp"

namespace {

using ahm::Index, ahm::Variant, ahm::bench::median_cpu_seconds, ahm::bench::report_bandwidth, ahm::bench::run,
    ahm::bench::Shape;

const ahm::CsrGraph& graph_for(const benchmark::State& state, Shape shape) {
  return graph_of(shape, static_cast<Index>(state.range(0)));
}

/// The solver of a graph, kept between calls.
const ahm::LogMapSolver& solver_of(const ahm::TangentGraph& graph) {
  static const ahm::TangentGraph* kept = nullptr;
  static std::optional<ahm::LogMapSolver> solver;
  if (kept != &graph || solver->operators().size() != graph.size()) {
    solver.emplace(graph, ahm::HeatOptions{.strategy = ahm::Strategy::global, .check_graph = false, .threads = 1});
    kept = &graph;
  }
  return *solver;
}

/// The solves of a map only: A and B for the source, then A for two columns (adaptive) or B for one (localized).
void run_solves(const ahm::HeatOperators& heat, Variant variant, std::vector<double>& X) {
  const auto n = static_cast<std::size_t>(heat.size());
  auto point = [&](std::size_t size) {
    std::fill_n(X.begin(), size, 0.0);
    X[size / 2] = 1;
    return std::span(X).first(size);
  };
  heat.solve_scalar(point(n), 1);
  heat.solve_vector(point(2 * n), 1);
  std::fill(X.begin(), X.end(), 1.0);
  variant == Variant::adaptive ? heat.solve_scalar(X, 2) : heat.solve_vector(X, 1);
}

/// One additional map on one thread. "outside solves" is the share of right-hand sides, frames and quotients.
void map(benchmark::State& state, Shape shape, Variant variant) {
  const ahm::CsrGraph& graph = graph_for(state, shape);
  const ahm::LogMapSolver& solver = solver_of(graph);
  const ahm::Source source = ahm::Source::at_vertex(ahm::Vertex(graph.size() / 2));
  for (auto _ : state) benchmark::DoNotOptimize(solver.solve(source, {.variant = variant, .threads = 1}));
  std::vector<double> X(2 * static_cast<std::size_t>(graph.size()));
  const double whole = median_cpu_seconds([&] { solver.solve(source, {.variant = variant, .threads = 1}); });
  const double solves = median_cpu_seconds([&] { run_solves(solver.operators(), variant, X); });
  state.counters["outside solves"] = 1 - solves / whole;
  state.SetItemsProcessed(state.iterations() * graph.size());
}

/// A whole map by march, without any factorization before.
void march(benchmark::State& state, Shape shape) {
  const ahm::CsrGraph& graph = graph_for(state, shape);
  const ahm::LogMapSolver solver(graph, {.strategy = ahm::Strategy::march, .check_graph = false, .threads = 1});
  const ahm::Source source = ahm::Source::at_vertex(ahm::Vertex(graph.size() / 2));
  ahm::MarchStatistics statistics;
  for (auto _ : state) statistics = solver.solve(source, {.threads = 1}).march();
  state.counters["bands"] = statistics.bands;
  state.counters["solved/vertex"] = static_cast<double>(statistics.solved) / graph.size();
  state.SetItemsProcessed(state.iterations() * graph.size());
}

/// Bytes of traffic: the graph without its weights and transports, coordinates and frames of each vertex, and coordinates
/// of its neighbors. Uses all cores; CPU time is the sum over them.
void quality(benchmark::State& state, Shape shape) {
  const ahm::CsrGraph& graph = graph_for(state, shape);
  const ahm::LogMap map =
      solver_of(graph).solve(ahm::Source::at_vertex(ahm::Vertex(graph.size() / 2)), {.threads = 1, .frames = true});
  const double seconds = run(state, [&] { benchmark::DoNotOptimize(ahm::map_quality(graph, map)); });
  state.SetItemsProcessed(state.iterations() * graph.size());
  report_bandwidth(state, (20.0 + 17.0) * static_cast<double>(graph.edge_count()) + 64.0 * graph.size(), seconds);
}

/// The maps around the first 1000 vertices, of about 100 vertices each.
void local_maps(benchmark::State& state, Shape shape) {
  const ahm::CsrGraph& graph = graph_for(state, shape);
  const double radius = 5.5 * graph.mean_edge_length() * graph.length_unit();
  std::vector<ahm::Vertex> vertices;
  for (Index v = 0; v < std::min<Index>(graph.size(), 1000); ++v) vertices.emplace_back(v);
  std::size_t entries = 0;
  for (auto _ : state)
    entries = ahm::local_maps(graph, vertices, {.radius = radius, .heat = {.check_graph = false, .threads = 1}})
                  .neighbors.size();
  state.counters["vertices/map"] = static_cast<double>(entries) / static_cast<double>(vertices.size());
  state.counters["maps/s"] =
      benchmark::Counter(static_cast<double>(vertices.size()), benchmark::Counter::kIsIterationInvariantRate);
}

void add_sizes(benchmark::internal::Benchmark* kernel) {
  kernel->ArgName("n")->Arg(2500)->Arg(40000)->Arg(160000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(map, adaptive_mesh, Shape::mesh, Variant::adaptive)->Apply(add_sizes);
BENCHMARK_CAPTURE(map, localized_mesh, Shape::mesh, Variant::localized)->Apply(add_sizes);
BENCHMARK_CAPTURE(map, adaptive_cloud, Shape::cloud, Variant::adaptive)->Apply(add_sizes);
BENCHMARK_CAPTURE(march, mesh, Shape::mesh)->Apply(add_sizes);
BENCHMARK_CAPTURE(march, cloud, Shape::cloud)->Apply(add_sizes);
BENCHMARK_CAPTURE(quality, mesh, Shape::mesh)->MeasureProcessCPUTime()->Apply(add_sizes);
BENCHMARK_CAPTURE(quality, cloud, Shape::cloud)->MeasureProcessCPUTime()->Apply(add_sizes);
BENCHMARK_CAPTURE(local_maps, mesh, Shape::mesh)->Apply(add_sizes);
BENCHMARK_CAPTURE(local_maps, cloud, Shape::cloud)->Apply(add_sizes);

}  // namespace
