// What maps cost before they are made.
#include "ahm/maps/cost.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/error.hpp"
#include "maps/cost.hpp"

namespace ahm::test {
namespace {

TEST(Cost, GrowsWithTheGraphAndMarchesInLessMemory) {
  for (int d : {2, 3})
    for (Strategy strategy : {Strategy::global, Strategy::march}) {
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

TEST(Cost, OfFactorsIsRightToAHalf) {
  const CsrGraph graph(sphere_graph(20000));
  const double bytes = static_cast<double>(HeatOperators(graph).statistics().bytes);
  const double estimate = estimate_cost({graph.size(), 2, graph.transport_kind()}, Strategy::global).bytes;
  EXPECT_GT(estimate, bytes);  // the peak holds more than the factors
  EXPECT_LT(estimate, 4 * bytes);
}

TEST(Cost, OfBlocksIsThatOfTheirNumbers) {
  const Cost rotations = estimate_cost({10000, 2, TransportKind::rotation2}, Strategy::global),
             blocks = estimate_cost({10000, 2, TransportKind::block}, Strategy::global);
  EXPECT_NEAR(blocks.bytes / rotations.bytes, 5.0 / 3.0, 1e-12);  // 1 + 4 numbers per entry instead of 1 + 2
}

TEST(Cost, OfAMarchOnTwoThreadsIsThatOfTwoBands) {
  constexpr GraphSize size{100'000, 2, TransportKind::rotation2};
  const Cost one = estimate_cost(size, Strategy::march, 1), two = estimate_cost(size, Strategy::march, 2);
  EXPECT_GT(two.bytes, 1.1 * one.bytes);
  EXPECT_LT(two.bytes, 1.8 * one.bytes);
  EXPECT_EQ(two.first_map_seconds, one.first_map_seconds);
  EXPECT_EQ(estimate_cost(size, Strategy::global, 1).bytes, estimate_cost(size, Strategy::global, 2).bytes);
}

CsrGraph sphere(Index n) { return CsrGraph(sphere_graph(n)); }

TEST(CostOfGraph, CountsFactorsExactly) {
  const CsrGraph graph = sphere(3000);
  for (Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
    const HeatOptions options{.ordering = ordering};
    const SystemSize size = system_size(graph, options);
    EXPECT_EQ(size.nonzeros, static_cast<double>(HeatOperators(graph, options.factor()).statistics().nonzeros_A));
    EXPECT_EQ(size.vertices, graph.size());
    EXPECT_EQ(size.edges, static_cast<double>(graph.edge_count()));
    EXPECT_GT(size.operations, 2 * size.nonzeros);
  }
}

TEST(CostOfGraph, KnowsTheBandsOfAMarch) {
  for (Index n : {4000, 40000}) {
    const CsrGraph graph = sphere(n);
    const Source source = Source::at_vertex(Vertex(7));
    const ComponentScales scales(graph);
    for (double t_coef : {1.0, 4.0}) {
      const HeatOptions options{.t_coef = t_coef, .strategy = Strategy::march};
      const MarchWork work = march_work(graph, source, ComponentTimes(scales, t_coef), INFINITY, options);
      const MarchStatistics found = LogMapSolver(graph, options).solve(source).march();
      EXPECT_NEAR(work.largest.vertices / found.largest_band, 1, 0.1) << n;
      EXPECT_NEAR(work.solved / static_cast<double>(found.solved), 1, 0.2) << n;
      EXPECT_EQ(work.reached, n);
    }
  }
}

TEST(CostOfGraph, GrowsWithTheRadiusUpToTheWholeGraph) {
  const CsrGraph graph = sphere(30000);
  const Source source = Source::at_vertex(Vertex(7));
  Cost last;
  for (double radius : {0.2, 0.6, 1.2, 2.0}) {
    const Cost cost = estimate_cost(graph, source, Strategy::march, {}, radius);
    EXPECT_GE(cost.bytes, last.bytes);
    EXPECT_GT(cost.first_map_seconds, last.first_map_seconds);
    last = cost;
  }
  const Cost whole = estimate_cost(graph, source, Strategy::march);
  EXPECT_LE(last.bytes, whole.bytes);
  EXPECT_LT(last.first_map_seconds, whole.first_map_seconds);
  EXPECT_LT(estimate_cost(graph, source, Strategy::march, {}, 0.2).bytes, 0.7 * whole.bytes);
  EXPECT_EQ(estimate_cost(graph, source, Strategy::global, {}, 0.2).bytes,
            estimate_cost(graph, source, Strategy::global).bytes);
}

TEST(CostOfGraph, IsThatOfTheSizeWhereASurfaceIsEven) {
  for (unsigned threads : {1u, 2u})
    for (Index n : {3000, 30000}) {
      const CsrGraph graph = sphere(n);
      for (Strategy strategy : {Strategy::global, Strategy::march}) {
        const Cost by_size = estimate_cost({n, 2, graph.transport_kind()}, strategy, threads),
                   by_graph = estimate_cost(graph, Source::at_vertex(Vertex(0)), strategy, {.threads = threads});
        EXPECT_NEAR(by_size.bytes / by_graph.bytes, 1, 0.5) << n << " " << to_string(strategy);
      }
    }
}

TEST(CostOfGraph, RefusesWhatCannotBeSolved) {
  const CsrGraph graph = sphere(100);
  const Source source = Source::at_vertex(Vertex(7));
  EXPECT_THROW(estimate_cost(graph, source, Strategy::automatic), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, source, Strategy::march, {}, 0), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, source, Strategy::march, {.t_coef = 0}), InvalidArgument);
  EXPECT_THROW(estimate_cost(graph, Source::at_vertex(Vertex(100)), Strategy::global), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
