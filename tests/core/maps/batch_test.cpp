// Many sources, many threads, progress and cancellation.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

class Batch : public testing::Test {
 protected:
  Batch() : graph(sphere_graph(600)), solver(graph) {
    for (Index p = 0; p < 37; ++p) sources.push_back(Source::at_vertex(Vertex(p * 16)));
  }
  CsrGraph graph;
  LogMapSolver solver;
  std::vector<Source> sources;
};

bool same_bits(const LogMap& a, const LogMap& b) {
  return std::equal(a.coordinates().begin(), a.coordinates().end(), b.coordinates().begin(), b.coordinates().end()) &&
         std::equal(a.status().begin(), a.status().end(), b.status().begin(), b.status().end());
}

TEST_F(Batch, SolvesFromManyThreadsAtOnce) {
  std::vector<LogMap> expected;
  for (const Source& source : sources) expected.push_back(solver.solve(source, {.threads = 1}));
  std::atomic<int> same{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t s = static_cast<std::size_t>(t) % 3; s < sources.size(); s += 3)
          same += same_bits(solver.solve(sources[s], {.threads = 1}), expected[s]);
      });
  }
  int calls = 0;
  for (int t = 0; t < 8; ++t)
    for (std::size_t s = static_cast<std::size_t>(t) % 3; s < sources.size(); s += 3) ++calls;
  EXPECT_EQ(same, calls);
}

TEST_F(Batch, AcceptsNoSourcesAtAll) { EXPECT_TRUE(solver.solve(std::span<const Source>()).empty()); }

TEST_F(Batch, ReportsProgressUpToTheEnd) {
  double last = -1;
  MapOptions options{.progress = Progress{}};
  options.progress->report = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "solve");
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  solver.solve(sources, options);
  EXPECT_EQ(last, 1.0);
}

TEST_F(Batch, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  MapOptions options{.progress = Progress{}};
  options.progress->stop = stop.get_token();
  EXPECT_THROW(solver.solve(sources, options), Cancelled);

  HeatOptions operator_options;
  operator_options.progress.stop = stop.get_token();
  EXPECT_THROW(LogMapSolver(graph, operator_options), Cancelled);
}

TEST_F(Batch, StopsInTheMiddle) {
  std::stop_source stop;
  MapOptions options{.progress = Progress{}};
  options.threads = 1;
  options.progress->stop = stop.get_token();
  options.progress->report = [&](std::string_view, double fraction) {
    if (fraction > 0) stop.request_stop();
  };
  EXPECT_THROW(solver.solve(sources, options), Cancelled);
}

TEST_F(Batch, ReportsTheStagesOfTheFactorization) {
  std::vector<std::string> stages;
  FactorOptions options;
  options.progress.report = [&](std::string_view stage, double) { stages.emplace_back(stage); };
  const HeatOperators heat(graph, options);
  EXPECT_EQ(stages, (std::vector<std::string>{"check", "assemble", "analyze", "factor", "factor"}));
  EXPECT_GT(heat.statistics().nonzeros_A, graph.size());
  EXPECT_GT(heat.statistics().bytes, 0u);
}

}  // namespace
}  // namespace ahm::test
