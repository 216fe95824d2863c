// The memory that a process may use (the machine, its control groups, its resource limits), and the cost of maps before they are computed.
#include "ahm/maps/cost.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "cholesky/memory_limits.hpp"
#include "core/solved_graph.hpp"
#include "maps/cost.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

namespace fs = std::filesystem;

/// A tree of control groups.
struct Groups {
  Groups() { fs::remove_all(root); }
  ~Groups() { fs::remove_all(root); }
  Groups(const Groups&) = delete;

  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((root / name).parent_path());
    std::ofstream(root / name) << text << '\n';
  }
  /// Limit of a process in these groups.
  double limit(const std::string& lines) const {
    write("self", lines);
    return control_group_limit(root / "self", root / "mounts");
  }
  const fs::path root = fs::path(testing::TempDir()) / ("ahm_groups_" + std::to_string(getpid()));
};

/// Lowers a limit of this process while it exists.
class LoweredLimit {
 public:
  LoweredLimit(__rlimit_resource which, rlim_t bytes) : which_(which) {
    getrlimit(which_, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(which_, &now);
  }
  ~LoweredLimit() { setrlimit(which_, &before_); }
  LoweredLimit(const LoweredLimit&) = delete;

 private:
  __rlimit_resource which_;
  rlimit before_{};
};

TEST(MemoryLimits, OfControlGroupsAreTheLeastFromTheGroupToTheRoot) {
  const Groups groups;
  EXPECT_TRUE(std::isinf(groups.limit("")));
  EXPECT_TRUE(std::isinf(control_group_limit("/no/such/file", "/no/such/folder")));
  groups.write("mounts/a/memory.max", "3000000000");
  groups.write("mounts/a/b/memory.max", "max");
  EXPECT_EQ(groups.limit("0::/a/b"), 3e9);
  groups.write("mounts/a/b/memory.max", "2000000000");
  EXPECT_EQ(groups.limit("0::/a/b"), 2e9);
  EXPECT_EQ(groups.limit("0::/a"), 3e9);
  EXPECT_TRUE(std::isinf(groups.limit("0::/")));
  groups.write("mounts/memory.max", "1000000000");  // of a container
  EXPECT_EQ(groups.limit("0::/"), 1e9);
  EXPECT_EQ(groups.limit("0::/../outside/the/container"), 1e9);
}

TEST(MemoryLimits, OfVersionOneGroupsAreReadToo) {
  const Groups groups;
  groups.write("mounts/memory/jobs/memory.limit_in_bytes", "4000000000");
  EXPECT_EQ(groups.limit("5:cpu:/jobs\n4:cpuset,memory:/jobs"), 4e9);
  EXPECT_TRUE(std::isinf(groups.limit("5:cpu:/jobs")));
  groups.write("mounts/unified/jobs/memory.max", "500000000");
  EXPECT_EQ(groups.limit("4:memory:/jobs\n0::/jobs"), 5e8);
}

TEST(MemoryLimits, IncludeResourceLimits) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const double machine = machine_memory();
  ASSERT_GT(machine, 1e9);
  for (const auto which : {RLIMIT_AS, RLIMIT_DATA}) {
    const LoweredLimit lowered(which, 1'000'000'000);
    EXPECT_EQ(machine_memory(), 1e9);
    EXPECT_EQ(choose_strategy({.vertices = 1'000'000}, {}), Strategy::march);  // the factors take more
  }
  EXPECT_EQ(machine_memory(), machine);
}

TEST(MemoryLimits, AreComparedWithTheMemoryOfTheMapsBeforeTheSolve) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const SolvedGraph sphere(sphere_graph(20000), {.strategy = Strategy::march});
  const std::vector<Source> sources(2000, source_at(0));
  const LoweredLimit lowered(RLIMIT_DATA, 1'000'000'000);
  expect_error<ResourceExhausted>([&] { sphere.solver.solve(sources); }, "2000 maps of 20000 vertices");
}

TEST(Cost, GrowsWithTheGraphAndMarchesInLessMemory) {
  for (int d : {2, 3})
    for (Strategy strategy : strategies) {
      Cost last;
      for (Index n : {1000, 10000, 100000, 1000000}) {
        const Cost cost = estimate_cost({n, d, TransportKind::block}, strategy);
        EXPECT_GT(cost.bytes, last.bytes);
        EXPECT_GT(cost.first_map_seconds, last.first_map_seconds);
        EXPECT_GT(cost.next_map_seconds, last.next_map_seconds);
        EXPECT_LE(cost.next_map_seconds, cost.first_map_seconds);
        last = cost;
      }
    }
  const GraphSize large{1'000'000, 2, TransportKind::rotation2};
  EXPECT_LT(estimate_cost(large, Strategy::march).bytes, estimate_cost(large, Strategy::global).bytes);
  EXPECT_THROW(estimate_cost(large, Strategy::automatic), InvalidArgument);
}

TEST(Cost, OfFactorsIsTheirMemoryUpToAFactorOfFour) {
  const CsrGraph graph(sphere_graph(20000));
  const double bytes = static_cast<double>(HeatOperators(graph).statistics().bytes);
  const double estimate = estimate_cost({graph.size(), 2, graph.transport_kind()}, Strategy::global).bytes;
  EXPECT_GT(estimate, bytes);  // at its peak the factorization stores more than the factors
  EXPECT_LT(estimate, 4 * bytes);
}

TEST(Cost, IsProportionalToTheNumbersOfAnEntryAndBoundedForTwoBands) {
#ifdef AHM_NO_THREADS
  GTEST_SKIP() << "for builds with threads";
#endif
  const Cost rotations = estimate_cost({10000, 2, TransportKind::rotation2}, Strategy::global),
             blocks = estimate_cost({10000, 2, TransportKind::block}, Strategy::global);
  EXPECT_NEAR(blocks.bytes / rotations.bytes, 5.0 / 3.0, 1e-12);  // 1 + 4 numbers per entry instead of 1 + 2
  constexpr GraphSize size{100'000, 2, TransportKind::rotation2};
  const Cost one = estimate_cost(size, Strategy::march, 1), two = estimate_cost(size, Strategy::march, 2);
  EXPECT_GT(two.bytes, 1.1 * one.bytes);
  EXPECT_LT(two.bytes, 1.8 * one.bytes);
  EXPECT_EQ(two.first_map_seconds, one.first_map_seconds);
  EXPECT_EQ(estimate_cost(size, Strategy::global, 1).bytes, estimate_cost(size, Strategy::global, 2).bytes);
}

TEST(CostOfGraph, IncludesTheExactNumberOfEntries) {
  const CsrGraph graph(sphere_graph(3000));
  for (Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
    const HeatOptions options{.ordering = ordering};
    const SystemSize size = system_size(graph, options);
    EXPECT_EQ(size.nonzeros, static_cast<double>(HeatOperators(graph, options.factor()).statistics().nonzeros_A));
    EXPECT_EQ(size.vertices, graph.size());
    EXPECT_EQ(size.edges, static_cast<double>(graph.edge_count()));
    EXPECT_GT(size.operations, 2 * size.nonzeros);
  }
}

TEST(CostOfGraph, IncludesTheBandsOfAMarch) {
  for (Index n : {4000, 40000}) {
    const CsrGraph graph(sphere_graph(n));
    const ComponentScales scales(graph);
    for (double t_coef : {1.0, 4.0}) {
      const HeatOptions options{.t_coef = t_coef, .strategy = Strategy::march};
      const MarchWork work = march_work(graph, source_at(7), ComponentTimes(scales, t_coef), INFINITY, options);
      const MarchStatistics found = LogMapSolver(graph, options).solve(source_at(7)).march();
      EXPECT_NEAR(work.largest.vertices / found.largest_band, 1, 0.1) << n;
      EXPECT_NEAR(work.solved / static_cast<double>(found.solved), 1, 0.2) << n;
      EXPECT_EQ(work.reached, n);
    }
  }
}

TEST(CostOfGraph, GrowsWithTheRadiusUpToTheWholeGraph) {
  const CsrGraph graph(sphere_graph(30000));
  const auto cost_of = [&](Strategy strategy, double radius = INFINITY) {
    return estimate_cost(graph, source_at(7), strategy, {}, radius);
  };
  Cost last;
  for (double radius : {0.2, 0.6, 1.2, 2.0}) {
    const Cost cost = cost_of(Strategy::march, radius);
    EXPECT_GE(cost.bytes, last.bytes);
    EXPECT_GT(cost.first_map_seconds, last.first_map_seconds);
    last = cost;
  }
  const Cost whole = cost_of(Strategy::march);
  EXPECT_LE(last.bytes, whole.bytes);
  EXPECT_LT(last.first_map_seconds, whole.first_map_seconds);
  EXPECT_LT(cost_of(Strategy::march, 0.2).bytes, 0.7 * whole.bytes);
  EXPECT_EQ(cost_of(Strategy::global, 0.2).bytes, cost_of(Strategy::global).bytes);
}

TEST(CostOfGraph, IsThatOfTheSizeOnEvenSurfaces) {
  for (unsigned threads : {1u, 2u})
    for (Index n : {3000, 30000}) {
      const CsrGraph graph(sphere_graph(n));
      for (Strategy strategy : strategies) {
        const Cost by_size = estimate_cost({n, 2, graph.transport_kind()}, strategy, threads),
                   by_graph = estimate_cost(graph, source_at(0), strategy, {.threads = threads});
        EXPECT_NEAR(by_size.bytes / by_graph.bytes, 1, 0.5) << n << " " << to_string(strategy);
      }
    }
}

TEST(CostOfGraph, RefusesInvalidArguments) {
  const CsrGraph graph(sphere_graph(100));
  EXPECT_THROW(estimate_cost(graph, source_at(7), Strategy::automatic), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, source_at(7), Strategy::march, {}, 0), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, source_at(7), Strategy::march, {.t_coef = 0}), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, source_at(100), Strategy::global), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
