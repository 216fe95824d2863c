// From graph to factors: assembly, symbolic analysis, factorization.
#include <benchmark/benchmark.h>

#include "ahm/cholesky/cholesky.hpp"
#include "graphs.hpp"
#include "heat/heat_system.hpp"
#include "machine.hpp"

namespace {

using ahm::Ordering, ahm::SparseUpper, ahm::bench::report_bandwidth, ahm::bench::report_flops, ahm::bench::run,
    ahm::bench::Shape;

ahm::AssembledOperators operators(const ahm::TangentGraph& graph) {
  const double h = graph.mean_edge_length();
  const std::vector<double> tau(static_cast<std::size_t>(graph.size()), h * h);
  return ahm::assemble(graph, tau, 1.0 / (h * h));
}

double bytes(const SparseUpper& matrix) {
  return 8.0 * static_cast<double>(matrix.column_begin.size() + matrix.rows.size() + matrix.values.size());
}

/// Assembles A and B in one pass. Bytes of traffic: the rows of the graph without logarithms, and both matrices.
void assemble(benchmark::State& state, Shape shape) {
  const ahm::CsrGraph& graph = graph_of(shape, static_cast<ahm::Index>(state.range(0)));
  const double seconds = run(state, [&] { benchmark::DoNotOptimize(operators(graph)); });
  const ahm::AssembledOperators matrices = operators(graph);
  state.counters["nnz"] = static_cast<double>(matrices.A.rows.size());
  state.SetItemsProcessed(state.iterations() * graph.size());
  report_bandwidth(
      state,
      bytes(matrices.A) + bytes(matrices.B) + 28.0 * static_cast<double>(graph.edge_count()) + 16.0 * graph.size(),
      seconds);
}

/// Ordering, elimination tree and supernodes, which A and B share.
void analyze(benchmark::State& state, Shape shape, Ordering ordering) {
  const ahm::AssembledOperators matrices = operators(graph_of(shape, static_cast<ahm::Index>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(ahm::SymbolicCholesky(matrices.A, ordering));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// Numerical factorization of the analyzed pattern, including the check of the residual.
void factorize(benchmark::State& state, Shape shape, Ordering ordering, bool scalar) {
  ahm::AssembledOperators matrices = operators(graph_of(shape, static_cast<ahm::Index>(state.range(0))));
  const ahm::SymbolicCholesky symbolic(matrices.A, ordering);
  const SparseUpper& matrix = scalar ? matrices.A : matrices.B;
  const double seconds =
      run(state, [&] { benchmark::DoNotOptimize(ahm::CholeskyFactor(matrix, symbolic, "benchmark")); });
  const ahm::CholeskyFactor factor(matrix, symbolic, "benchmark");
  state.counters["stored"] = static_cast<double>(factor.nonzeros());
  state.counters["MB"] = 1e-6 * static_cast<double>(factor.bytes());
  state.SetItemsProcessed(state.iterations() * state.range(0));
  report_flops(state, symbolic.operations() * (scalar ? 1 : 4), seconds);
}

void add_sizes(benchmark::internal::Benchmark* kernel) {
  kernel->ArgName("n")->Arg(2500)->Arg(40000)->Arg(160000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(assemble, mesh, Shape::mesh)->Apply(add_sizes);
BENCHMARK_CAPTURE(assemble, cloud, Shape::cloud)->Apply(add_sizes);
BENCHMARK_CAPTURE(analyze, mesh_amd, Shape::mesh, Ordering::amd)->Apply(add_sizes);
BENCHMARK_CAPTURE(analyze, mesh_nested_dissection, Shape::mesh, Ordering::nested_dissection)->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, A_mesh_amd, Shape::mesh, Ordering::amd, true)->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, B_mesh_amd, Shape::mesh, Ordering::amd, false)->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, A_mesh_nested_dissection, Shape::mesh, Ordering::nested_dissection, true)
    ->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, B_mesh_nested_dissection, Shape::mesh, Ordering::nested_dissection, false)
    ->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, A_cloud_amd, Shape::cloud, Ordering::amd, true)->Apply(add_sizes);
BENCHMARK_CAPTURE(factorize, B_cloud_amd, Shape::cloud, Ordering::amd, false)->Apply(add_sizes);

}  // namespace
