// What maps cost before they are made.
#include "ahm/maps/cost.hpp"

#include <gtest/gtest.h>

#include "ahm/error.hpp"
#include "ahm/testing/curved_graphs.hpp"

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

TEST(Cost, OfOrderTwoIsThatOfItsTimes) {
  for (const auto& [n, times] : {std::pair{5000, 2.0}, std::pair{50000, 3.0}}) {
    const GraphSize size{n, 2, TransportKind::rotation2};
    const Cost one = estimate_cost(size, Strategy::global), two = estimate_cost(size, Strategy::global, 2);
    EXPECT_NEAR(two.first_map_seconds / one.first_map_seconds, times, 1e-12);
    EXPECT_LT(two.bytes, times * one.bytes);  // the factors are kept, all else is used again
    EXPECT_GT(two.bytes, one.bytes * (1 + (times - 1) / 2));
    const Cost march = estimate_cost(size, Strategy::march), marches = estimate_cost(size, Strategy::march, 2);
    EXPECT_NEAR(marches.first_map_seconds / march.first_map_seconds, times, 1e-12);
    EXPECT_GT(marches.bytes, march.bytes);  // the bands of longer times are deeper
  }
}

TEST(Cost, OfOrderTwoCountsForTheChoice) {
  constexpr GraphSize size{200'000, 2, TransportKind::rotation2};
  const auto memory = static_cast<std::size_t>(1.5 * estimate_cost(size, Strategy::global).bytes);
  EXPECT_EQ(choose_strategy(size, {.order = 1, .memory = memory}), Strategy::global);
  EXPECT_EQ(choose_strategy(size, {.order = 2, .memory = memory}), Strategy::march);
}

}  // namespace
}  // namespace ahm::test
