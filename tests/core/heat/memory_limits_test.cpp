// What limits a process's memory: the machine, its control groups, its resource limits.
#include "cholesky/memory_limits.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

namespace fs = std::filesystem;

/// A tree of control groups.
class Groups {
 public:
  Groups() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::path(testing::TempDir()) / (std::string("ahm_groups_") + test->name());
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~Groups() { fs::remove_all(root_); }
  Groups(const Groups&) = delete;

  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text << '\n';
  }
  /// Of a process in these groups.
  double limit(const std::string& lines) const {
    write("self", lines);
    return control_group_limit(root_ / "self", root_ / "mounts");
  }

 private:
  fs::path root_;
};

/// Lowers a limit of this process, and takes it back.
class Lowered {
 public:
  Lowered(__rlimit_resource which, rlim_t bytes) : which_(which) {
    getrlimit(which_, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(which_, &now);
  }
  ~Lowered() { setrlimit(which_, &before_); }
  Lowered(const Lowered&) = delete;

 private:
  __rlimit_resource which_;
  rlimit before_{};
};

TEST(MemoryLimits, OfControlGroupsAreTheLeastOnTheWayToTheRoot) {
  const Groups groups;
  groups.write("mounts/a/memory.max", "3000000000");
  groups.write("mounts/a/b/memory.max", "max");
  EXPECT_EQ(groups.limit("0::/a/b"), 3e9);
  groups.write("mounts/a/b/memory.max", "2000000000");
  EXPECT_EQ(groups.limit("0::/a/b"), 2e9);
  EXPECT_EQ(groups.limit("0::/a"), 3e9);
  EXPECT_TRUE(std::isinf(groups.limit("0::/")));
}

TEST(MemoryLimits, OfAContainerAreThoseOfItsRoot) {
  const Groups groups;
  groups.write("mounts/memory.max", "1000000000");
  EXPECT_EQ(groups.limit("0::/"), 1e9);
  EXPECT_EQ(groups.limit("0::/../outside/the/container"), 1e9);
}

TEST(MemoryLimits, OfTheOlderHierarchiesCountToo) {
  const Groups groups;
  groups.write("mounts/memory/jobs/memory.limit_in_bytes", "4000000000");
  EXPECT_EQ(groups.limit("5:cpu:/jobs\n4:cpuset,memory:/jobs"), 4e9);
  EXPECT_TRUE(std::isinf(groups.limit("5:cpu:/jobs")));
  groups.write("mounts/unified/jobs/memory.max", "500000000");
  EXPECT_EQ(groups.limit("4:memory:/jobs\n0::/jobs"), 5e8);
}

TEST(MemoryLimits, AreNoneWithoutGroups) {
  const Groups groups;
  EXPECT_TRUE(std::isinf(groups.limit("")));
  EXPECT_TRUE(std::isinf(control_group_limit("/no/such/file", "/no/such/folder")));
}

TEST(MemoryLimits, OfResourcesCountAsTheMachines) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const double machine = machine_memory();
  ASSERT_GT(machine, 1e9);
  constexpr rlim_t bytes = 1'000'000'000;
  for (const auto which : {RLIMIT_AS, RLIMIT_DATA}) {
    const Lowered lowered(which, bytes);
    EXPECT_EQ(machine_memory(), 1e9);
    EXPECT_EQ(choose_strategy({.vertices = 1'000'000}, {}), Strategy::march);  // the factors take more
  }
  EXPECT_EQ(machine_memory(), machine);
}

TEST(MemoryLimits, AreNotFilledByMapsThatAreKnownNotToFit) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const CsrGraph graph(sphere_graph(20000));
  const LogMapSolver solver(graph, {.strategy = Strategy::march});
  const std::vector<Source> sources(2000, Source::at_vertex(Vertex(0)));
  const Lowered lowered(RLIMIT_DATA, 1'000'000'000);
  expect_error<ResourceExhausted>([&] { solver.solve(sources); }, "2000 maps of 20000 vertices do not fit into memory");
}

}  // namespace
}  // namespace ahm::test
