// Schedules of marches: the number of vertices of each band in each tile, and the tiles of each rank.
#include <set>

#include "ahm/tiles/march_schedule.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::BandTiles;
using tiles::Deal;
using tiles::deal_tiles;
using tiles::march_schedule;
using tiles::share_out;

/// Bands as wide as their step do not overlap. Then each vertex is in one band, and each vertex with neighbors in another tile
/// is in one border. In bands of twice the width each vertex is twice, except that those of the first step are in one band.
TEST(MarchSchedule, HasEachVertexInWidthOverStepBands) {
  const TiledCloud cloud(hills(40), {.tile_points = 300});
  const TiledGraph graph = cloud.graph();
  const std::vector<Index> tiles = graph.manifest().first_vertices();
  const Vertex sources[] = {graph.vertex_of_row(Row(40 * 20 + 20)).value()};
  const auto narrow = march_schedule(graph, sources, tiles, {.step = 6, .width = 6});
  std::vector<std::int64_t> vertices_of(graph.tiles(), 0);
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> expected_borders, borders;
  for (const BandTiles& band : narrow) {
    for (const auto& [tile, vertices] : band.vertices) vertices_of[tile] += vertices;
    for (const auto& [pair, vertices] : band.borders) borders[pair] += vertices;
  }
  for (std::size_t t = 0; t < graph.tiles(); ++t) EXPECT_EQ(vertices_of[t], tiles[t + 1] - tiles[t]);
  for (Index i = 0; i < graph.size(); ++i) {
    std::set<std::size_t> others;
    for (Index j : graph.star(i).neighbors) others.insert(graph.tile_of(j));
    others.erase(graph.tile_of(i));
    for (std::size_t other : others) ++expected_borders[{graph.tile_of(i), other}];
  }
  EXPECT_GT(expected_borders.size(), 5u);
  EXPECT_EQ(borders, expected_borders);
  const auto wide = march_schedule(graph, sources, tiles, {.step = 6, .width = 12});
  const auto load = share_out(wide, deal_tiles(tiles, Deal::ranges, 1), 1);
  std::int64_t first = 0;
  for (const auto& [tile, vertices] : narrow.front().vertices) first += vertices;
  EXPECT_EQ(load.solved, 2 * std::int64_t{graph.size()} - first);
  EXPECT_EQ(load.balance, 1);
  EXPECT_EQ(load.active, 1);
  expect_error<InvalidArgument>([&] { march_schedule(graph, sources, tiles, {.step = 6, .width = 5}); }, "step");
}

TEST(MarchSchedule, WaitsForTheBusiestRank) {
  const std::vector<BandTiles> bands{{{{0, 30}, {1, 10}}, {{{0, 1}, 3}, {{1, 0}, 4}, {{0, 2}, 5}}},
                                     {{{1, 20}, {2, 20}}, {}}};
  const std::vector<int> owner{0, 1, 0};
  const auto load = share_out(bands, owner, 2);
  EXPECT_EQ(load.solved, 80);
  EXPECT_EQ(load.largest_band, 40);
  EXPECT_EQ(load.largest_part, 30);
  EXPECT_EQ(load.active, 2);
  EXPECT_EQ(load.messages, 1);  // two in the first band, none in the second; tiles 0 and 2 have the same rank
  EXPECT_EQ(load.halo, 2);      // 4 and 0
  EXPECT_DOUBLE_EQ(load.balance, 80.0 / (2 * (30 + 20)));
}

TEST(MarchSchedule, DealsTilesInTheOrderOfTheFront) {
  const std::vector<Index> tiles = tiles::equal_tiles(100, 7);
  const Vec3 middles[] = {{9, 0, 0}, {1, 0, 0}, {5, 0, 0}, {0, 0, 0}, {4, 0, 0}, {8, 0, 0}, {2, 0, 0}};
  const Vec3 one_source[] = {{0, 0, 0}}, two_sources[] = {{0, 3, 4}, {9, 0, 0}};
  const auto distances = tiles::tile_distances(middles, one_source);
  EXPECT_EQ(distances, (std::vector<double>{9, 1, 5, 0, 4, 8, 2}));
  EXPECT_EQ(tiles::tile_distances(middles, two_sources)[0], 0);
  EXPECT_EQ(tiles::tile_distances(middles, two_sources)[3], 5);
  // First 1, 3 and 6, then 2, 4 and 5, then 0.
  EXPECT_EQ(deal_tiles(tiles, Deal::arrival, 3, distances), (std::vector<int>{0, 0, 0, 1, 1, 2, 2}));
  expect_error<InvalidArgument>([&] { deal_tiles(tiles, Deal::arrival, 3); }, "0 for 7");
}

TEST(MarchSchedule, DealsTilesInRangesOrAsCards) {
  const std::vector<Index> tiles = tiles::equal_tiles(100, 6);
  EXPECT_EQ(tiles.front(), 0);
  EXPECT_EQ(tiles.back(), 100);
  expect_error<InvalidArgument>([] { tiles::equal_tiles(100, 0); }, "tiles is 0");
  expect_error<InvalidArgument>([] { tiles::equal_tiles(100, 101); }, "vertices, 100");
  EXPECT_EQ(deal_tiles(tiles, Deal::ranges, 3), (std::vector<int>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(deal_tiles(tiles, Deal::cards, 3), (std::vector<int>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(deal_tiles(std::vector<Index>{0, 0}, Deal::ranges, 2), std::vector<int>{0});  // an empty tile
}

/// Mean positions of the vertices of each tile. @param first  first vertex of each tile
std::vector<Vec3> mean_positions(const TiledGraph& graph, const std::vector<Index>& first) {
  std::vector<Vec3> means(first.size() - 1, Vec3{0, 0, 0});
  for (std::size_t t = 0; t < means.size(); ++t)
    for (Index i = first[t]; i < first[t + 1]; ++i)
      for (std::size_t c = 0; c < 3; ++c) means[t][c] += graph.frame(i)->origin[c] / (first[t + 1] - first[t]);
  return means;
}

TEST(MarchSchedule, ReadsTheMeanPositionsOfTiles) {
  const TiledCloud cloud(hills(60), {.tile_points = 700});
  const TiledGraph graph = cloud.graph();
  const std::vector<Vec3> expected = mean_positions(graph, graph.manifest().first_vertices()), found = graph.middles();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t t = 0; t < found.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[t][c], expected[t][c], 1e-11);
  // Files of earlier versions have no mean positions.
  const std::vector<double> lengths{graph.mean_edge_length()};
  tiles::write_arrays(cloud.tiles / "components", "components", {tiles::array("edge_lengths", lengths)});
  expect_error<IoError>([&] { graph.middles(); }, "--deal cards");
}

TEST(MarchSchedule, IsMostEvenByArrival) {
  const TiledCloud cloud(hills(80));
  const TiledGraph graph = cloud.graph();
  const std::vector<Index> tiles = tiles::equal_tiles(graph.size(), 100);
  for (Row row : {Row(0), Row(80 * 40 + 40)}) {
    const Vertex sources[] = {graph.vertex_of_row(row).value()};
    const Vec3 positions[] = {graph.frame(sources[0].index)->origin};
    const auto distances = tiles::tile_distances(mean_positions(graph, tiles), positions);
    const auto bands = march_schedule(graph, sources, tiles, {.step = 3, .width = 6});
    const auto balance = [&](Deal deal) { return share_out(bands, deal_tiles(tiles, deal, 8, distances), 8).balance; };
    EXPECT_GT(balance(Deal::arrival), balance(Deal::cards));
    EXPECT_GT(balance(Deal::arrival), balance(Deal::ranges));
  }
}

}  // namespace
}  // namespace ahm::test
