// Triangular solves with the factors of A and B, for 1, 2, 4 and 64 right-hand sides.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "ahm/cholesky/cholesky.hpp"
#include "graphs.hpp"
#include "heat/heat_system.hpp"
#include "machine.hpp"

namespace {

using ahm::Index, ahm::Ordering, ahm::bench::report_bandwidth, ahm::bench::report_flops, ahm::bench::run,
    ahm::bench::Shape;

/// The factor of A or of B, cached between calls.
const ahm::CholeskyFactor& factor_of(const ahm::TangentGraph& graph, Shape shape, bool scalar) {
  struct CachedFactor {
    Shape shape;
    Index n;
    bool scalar;
    ahm::CholeskyFactor factor;
  };
  static std::unique_ptr<CachedFactor> cached;
  if (!cached || cached->shape != shape || cached->n != graph.size() || cached->scalar != scalar) {
    cached.reset();
    const double h = graph.mean_edge_length();
    const std::vector<double> tau(static_cast<std::size_t>(graph.size()), h * h);
    const ahm::AssembledOperators matrices = ahm::assemble(graph, tau, 1.0 / (h * h));
    const ahm::SymbolicCholesky symbolic(matrices.A, Ordering::amd);
    cached = std::make_unique<CachedFactor>(
        shape, graph.size(), scalar, ahm::CholeskyFactor(scalar ? matrices.A : matrices.B, symbolic, "benchmark"));
  }
  return cached->factor;
}

/// Bytes of traffic: the factor once forwards and once backwards, the right-hand sides in and out. `point` is the
/// right-hand side of one source, where the forward solve skips entries that stay zero; otherwise it is dense.
void solve(benchmark::State& state, Shape shape, bool scalar, bool point) {
  const auto n = static_cast<Index>(state.range(0)), columns = static_cast<Index>(state.range(1));
  const ahm::CsrGraph& graph = graph_of(shape, n);
  const ahm::CholeskyFactor& factor = factor_of(graph, shape, scalar);
  const std::size_t rows = static_cast<std::size_t>(graph.size()) * (scalar ? 1 : 2);
  std::vector<double> rhs(rows * static_cast<std::size_t>(columns), point ? 0.0 : 1.0), X(rhs.size());
  for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) rhs[c * rows + rows / 2] = 1.0;
  const double seconds = run(state, [&] {
    std::ranges::copy(rhs, X.begin());
    factor.solve(X, columns);
  });
  state.counters["MB"] = 1e-6 * static_cast<double>(factor.bytes());
  state.counters["us/column"] = 1e6 * seconds / columns;
  const double flops = 4.0 * static_cast<double>(factor.nonzeros()) * columns * (scalar ? 1 : 4);
  if (columns > 4) return report_flops(state, flops, seconds);
  state.counters["GFlop/s"] = 1e-9 * flops / seconds;
  report_bandwidth(state, 2.0 * static_cast<double>(factor.bytes()) + 32.0 * static_cast<double>(rhs.size()), seconds);
}

void add_sizes(benchmark::internal::Benchmark* kernel) {
  kernel->ArgNames({"n", "columns"})
      ->ArgsProduct({{2500, 40000, 160000}, {1, 2, 4, 64}})
      ->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(solve, A_mesh, Shape::mesh, true, false)->Apply(add_sizes);
BENCHMARK_CAPTURE(solve, B_mesh, Shape::mesh, false, false)->Apply(add_sizes);
BENCHMARK_CAPTURE(solve, A_cloud, Shape::cloud, true, false)->Apply(add_sizes);
BENCHMARK_CAPTURE(solve, B_cloud, Shape::cloud, false, false)->Apply(add_sizes);
BENCHMARK_CAPTURE(solve, A_mesh_point, Shape::mesh, true, true)->Apply(add_sizes);
BENCHMARK_CAPTURE(solve, B_mesh_point, Shape::mesh, false, true)->Apply(add_sizes);

}  // namespace
