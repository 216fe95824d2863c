#include "choose_strategy.hpp"

#include <unistd.h>

#include <cmath>

namespace ahm {
namespace {

/// Graphs of at least this many vertices are marched when only one map is wanted (docs/march.md has the measurements).
constexpr Index march_from = 50'000;

/// Bytes of memory this machine has; 0 when the system does not say.
double machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : 0;
}

}  // namespace

double factor_bytes(const TangentGraph& graph) {
  const double n = graph.size(), d = graph.dimension();
  // Entries of the factor of A: nested dissection theory, c n log n for surfaces and c n^(4/3) for volumes, with the
  // constants measured for minimum degree. The factor of B has 2 real numbers for each (complex), or d x d.
  const double entries = d <= 2 ? 2.0 * n * std::log2(n + 1) : 12.0 * std::pow(n, 4.0 / 3.0);
  const double numbers = graph.transport_kind() == TransportKind::rotation2 ? 2 : d * d;
  return 8 * entries * (1 + numbers) + 60.0 * static_cast<double>(graph.edge_count()) * (1 + numbers) / 3;
}

Strategy choose_strategy(const TangentGraph& graph, const SolverOptions& options) {
  if (options.strategy != Strategy::automatic) return options.strategy;
  if (options.expected_maps == 1 && graph.size() >= march_from && graph.dimension() <= 2) return Strategy::march;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : 0.5 * machine_memory();
  return memory > 0 && factor_bytes(graph) > memory ? Strategy::march : Strategy::global;
}

}  // namespace ahm
