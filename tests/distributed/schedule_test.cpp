// The schedule of a march tells how many vertices of each band are whose.
#include <gtest/gtest.h>

#include <numeric>

#include "ahm/distributed/march_schedule.hpp"
#include "ahm/error.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using distributed::BandTiles;
using distributed::Deal;
using distributed::deal_tiles;
using distributed::march_schedule;
using distributed::share_out;

TEST(MarchSchedule, HasEachVertexInWidthOverStepBands) {
  const TiledCloud cloud(hills(40), {.tile_points = 300});
  cloud.build();
  const distributed::TiledGraph graph(cloud.tiles, 1 << 30);
  const std::vector<Index> tiles = graph.manifest().first_vertices();
  const Vertex sources[] = {graph.vertex_of_row(Row(40 * 20 + 20)).value()};
  std::vector<std::int64_t> of_tile(graph.tiles(), 0);
  for (const BandTiles& band : march_schedule(graph, sources, tiles, {.step = 6, .width = 6}))
    for (const auto& [tile, vertices] : band) of_tile[tile] += vertices;
  for (std::size_t t = 0; t < graph.tiles(); ++t) EXPECT_EQ(of_tile[t], tiles[t + 1] - tiles[t]);
  // Twice as wide, each is in two bands, those of the first step alone in one.
  const auto wide = march_schedule(graph, sources, tiles, {.step = 6, .width = 12});
  const auto load = share_out(wide, deal_tiles(tiles, Deal::ranges, 1), 1);
  const auto near = march_schedule(graph, sources, tiles, {.step = 6, .width = 6}).front();
  const std::int64_t first =
      std::accumulate(near.begin(), near.end(), std::int64_t{0}, [](auto sum, auto tile) { return sum + tile.second; });
  EXPECT_EQ(load.solved, 2 * std::int64_t{graph.size()} - first);
  EXPECT_EQ(load.balance, 1);
  EXPECT_EQ(load.active, 1);
  expect_error<InvalidArgument>([&] { march_schedule(graph, sources, tiles, {.step = 6, .width = 5}); }, "step");
}

TEST(MarchSchedule, WaitsForTheBusiestRank) {
  const std::vector<BandTiles> bands{{{0, 30}, {1, 10}}, {{1, 20}, {2, 20}}};
  const std::vector<int> owner{0, 1, 0};
  const auto load = share_out(bands, owner, 2);
  EXPECT_EQ(load.solved, 80);
  EXPECT_EQ(load.largest_band, 40);
  EXPECT_EQ(load.largest_part, 30);
  EXPECT_EQ(load.active, 2);
  EXPECT_DOUBLE_EQ(load.balance, 80.0 / (2 * (30 + 20)));
}

TEST(MarchSchedule, TilesAreDealtInRangesOrAsCards) {
  const std::vector<Index> tiles = distributed::equal_tiles(100, 6);
  EXPECT_EQ(tiles.front(), 0);
  EXPECT_EQ(tiles.back(), 100);
  EXPECT_EQ(deal_tiles(tiles, Deal::ranges, 3), (std::vector<int>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(deal_tiles(tiles, Deal::cards, 3), (std::vector<int>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(deal_tiles(std::vector<Index>{0, 0}, Deal::ranges, 2), std::vector<int>{0});  // an empty one
}

}  // namespace
}  // namespace ahm::test
