#include "ahm/maps/cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "ahm/error.hpp"
#include "maps/memory_limits.hpp"

namespace ahm {
namespace {

/// Graphs of at least this many vertices are marched when only one map is wanted (docs/march.md has the measurements).
constexpr Index march_from = 50'000, march_volumes_from = 10'000;

/// Nested dissection theory with constants fitted: O(n log n) memory and O(n^1.5) time on surfaces, O(n^(4/3)) and O(n^2)
/// in volumes.
Cost global(double n, int d, double numbers) {
  if (d > 2) return {140 * numbers * std::pow(n, 4.0 / 3.0), 3.4e-10 * numbers * n * n, 3e-7 * numbers * n};
  const double share = numbers / 3;  // 1 real and 1 complex number per entry
  return {share * 200 * n * std::log2(n + 1), share * (2e-6 * n + 1.5e-8 * std::pow(n, 1.5)),
          share * 3e-8 * n * std::log2(n + 1)};
}

/// Linear, but for the band at hand.
Cost march(double n, int d, double numbers) {
  const double seconds = d > 2 ? 1.5e-6 * numbers * n : 2e-6 * numbers * n;
  const double band = d > 2 ? 150 * numbers * std::min(n, 60 * std::pow(n, 2.0 / 3.0)) : 4e4 * numbers * std::sqrt(n);
  return {8 * (numbers + 3 * d + 3) * n + band, seconds, seconds};
}

}  // namespace

Cost estimate_cost(const GraphSize& size, Strategy strategy) {
  if (strategy == Strategy::automatic) throw InvalidArgument("estimate_cost: strategy must be global or march");
  const double n = size.vertices;
  // Real numbers per entry of the operators A and B.
  const double numbers = 1.0 + static_cast<double>(TransportLayout{size.kind, size.dimension}.width());
  return strategy == Strategy::global ? global(n, size.dimension, numbers) : march(n, size.dimension, numbers);
}

Strategy choose_strategy(const GraphSize& size, const HeatOptions& options) {
  if (options.strategy != Strategy::automatic) return options.strategy;
  if (options.expected_maps == 1 && size.vertices >= (size.dimension > 2 ? march_volumes_from : march_from))
    return Strategy::march;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : 0.5 * machine_memory();
  return memory > 0 && estimate_cost(size, Strategy::global).bytes > memory ? Strategy::march : Strategy::global;
}

double machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  const double limit = std::min(resource_limit(), control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
  const double machine = pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : INFINITY;
  const double least = std::min(machine, limit);
  return std::isinf(least) ? 0 : least;
}

}  // namespace ahm
