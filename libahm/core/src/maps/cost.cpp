#include "ahm/maps/cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "ahm/error.hpp"
#include "heat/memory_limits.hpp"

namespace ahm {
namespace {

/// Graphs of at least this many vertices are marched when only one map is wanted (docs/march.md has the measurements).
constexpr Index march_from = 50'000, march_volumes_from = 10'000;

/// The longest diffusion time of an order by its factor of t_coef, and how many there are (`DiffusionTimes`).
struct Times {
  Times(double n, int d, int order) {
    if (order == 1) return;
    const double c = std::pow(n, 1.0 / d) / 50;
    count = c < 2 ? 2 : 3;
    longest = 2 * std::max(1.0, c < 2 ? 1.0 : c);
  }
  double count = 1, longest = 1;
};

/// Nested dissection theory with constants fitted: O(n log n) memory and O(n^1.5) time on surfaces, O(n^(4/3)) and O(n^2)
/// in volumes. The factors of all times are kept.
Cost global(double n, int d, double numbers, const Times& times) {
  if (d > 2)
    return {times.count * 140 * numbers * std::pow(n, 4.0 / 3.0), times.count * 3.4e-10 * numbers * n * n,
            times.count * 3e-7 * numbers * n};
  const double share = numbers / 3;  // 1 real and 1 complex number per entry
  return {share * (times.count * 100 * n * std::log2(n + 1) + 900 * n),
          share * times.count * (2.5e-6 * n + 2e-8 * std::pow(n, 1.5)),
          share * times.count * 3e-8 * n * std::log2(n + 1)};
}

/// Linear, but for the band at hand, whose depth grows with the root of the diffusion time.
Cost march(double n, int d, double numbers, const Times& times) {
  const double seconds = times.count * (d > 2 ? 1.5e-6 : 3.3e-6) * numbers * n, depth = std::sqrt(times.longest);
  const double band = d > 2 ? 150 * numbers * std::min(n, depth * 60 * std::pow(n, 2.0 / 3.0))
                            : 4e4 * numbers * std::min(depth * std::sqrt(n), n / 60);
  return {8 * (numbers + 4 * d + 5) * n + (d > 2 ? 0 : 180 * n) + band, seconds, seconds};
}

}  // namespace

Cost estimate_cost(const GraphSize& size, Strategy strategy, int order) {
  if (strategy == Strategy::automatic) throw InvalidArgument("estimate_cost: strategy must be global or march");
  const double n = size.vertices;
  // Real numbers per entry of the operators A and B.
  const double numbers = 1.0 + static_cast<double>(TransportLayout{size.kind, size.dimension}.width());
  const Times times(n, size.dimension, order);
  return strategy == Strategy::global ? global(n, size.dimension, numbers, times)
                                      : march(n, size.dimension, numbers, times);
}

Strategy choose_strategy(const GraphSize& size, const HeatOptions& options) {
  if (options.strategy != Strategy::automatic) return options.strategy;
  if (options.expected_maps == 1 && size.vertices >= (size.dimension > 2 ? march_volumes_from : march_from))
    return Strategy::march;
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : 0.5 * machine_memory();
  return memory > 0 && estimate_cost(size, Strategy::global, options.order).bytes > memory ? Strategy::march
                                                                                           : Strategy::global;
}

double machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  const double limit = std::min(resource_limit(), control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
  const double machine = pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : INFINITY;
  const double least = std::min(machine, limit);
  return std::isinf(least) ? 0 : least;
}

}  // namespace ahm
