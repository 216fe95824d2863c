// The graph of tiles is that of the whole cloud in memory, edge for edge and bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "ahm/tiles/tiled_log_map.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::TiledGraph;

void expect_same(const TiledCloud& cloud, std::size_t least_tiles) {
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 22);
  EXPECT_GE(graph.tiles(), least_tiles);
  pointcloud::CloudOptions options;
  if (const Index k = graph.manifest().options.k; k > 0) options.k = k;
  options.drop_non_finite = graph.manifest().options.drop_non_finite;
  options.parts_apart = false;
  expect_same_graph(graph, pointcloud::PointCloudSurface::build(cloud.points, {}, options));
}

TEST(TiledGraph, IsThatOfHills) { expect_same(TiledCloud(hills(220)), 15); }

TEST(TiledGraph, IsThatOfARandomSphere) { expect_same(TiledCloud(random_sphere(40'000).points), 12); }

TEST(TiledGraph, IsThatOfARegularGrid) {  // neighbours at equal distances, cocircular everywhere
  expect_same(TiledCloud(hills(150, 1, 0)), 6);
  std::vector<Vec3> flat = hills(150, 1, 0);
  for (Vec3& p : flat) p[2] = 0;
  expect_same(TiledCloud(flat), 6);
}

TEST(TiledGraph, IsThatOfAMoebiusBand) {  // reflections
  const TiledCloud cloud(moebius_cloud(30'000).points);
  expect_same(cloud, 8);
  EXPECT_EQ(TiledGraph(cloud.tiles, 1 << 22).transport_kind(), TransportKind::block);
}

TEST(TiledGraph, IsThatOfIslandsOfDifferentDensityWithDuplicates) {
  std::vector<Vec3> points = hills(120);
  for (const Vec3& p : hills(100, 2)) points.push_back({300 + 2 * p[0], 2 * p[1], 50 + p[2]});
  for (const Vec3& p : hills(80, 3)) points.push_back({0.5 * p[0], 400 + 0.5 * p[1], p[2]});
  for (std::size_t i = 0; i < points.size(); i += 7) points.push_back(points[i]);
  const TiledCloud cloud(points);
  expect_same(cloud, 10);
  EXPECT_GT(TiledGraph(cloud.tiles, 1 << 22).manifest().components, 2);
}

TEST(TiledGraph, IsThatOfACloudWithStrayPoints) {  // they have no neighbours near, and no vertex
  std::vector<Vec3> points = hills(110);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-400, 500);
  for (int i = 0; i < 40; ++i) points.push_back({place(random), place(random), place(random)});
  expect_same(TiledCloud(points), 4);
}

TEST(TiledGraph, IsThatOfScanLines) {  // neighbours on a line, of which more are taken
  std::vector<Vec3> points;
  for (int line = 0; line < 40; ++line)
    for (int i = 0; i < 800; ++i) points.push_back({0.05 * i, 1.0 * line, std::sin(0.05 * i / 5)});
  expect_same(TiledCloud(points), 8);
}

TEST(TiledGraph, IsThatOfACloudWithTilesWithoutVertices) {
  std::vector<Vec3> points = hills(70);
  for (int i = 0; i < 4000; ++i) points.push_back({1.0 * i, 300, 0});  // a line has no planes
  const TiledCloud cloud(points, {.tile_points = 1000});
  expect_same(cloud, 6);
  const TiledGraph graph(cloud.tiles, 1 << 22);
  const auto empty = [](const tiles::TileFacts& tile) { return tile.points > 0 && tile.vertices == 0; };
  EXPECT_TRUE(std::ranges::any_of(graph.manifest().tiles, empty));
  const auto map = cloud.folder.directory() / "map";
  EXPECT_EQ(write_log_map(graph, Source::at_vertex(Vertex{0}), map, {}).ok, graph.size());
  tiles::write_rows(graph, map, cloud.folder.directory() / "map.csv");
}

TEST(TiledGraph, IsThatOfAThinWall) {
  std::vector<Vec3> points = hills(110);
  for (const Vec3& p : hills(110, 9)) points.push_back({p[0], p[1], p[2] + 2});
  expect_same(TiledCloud(points), 6);
}

TEST(TiledGraph, IsThatOfACloudWithPointsThatAreNotFinite) {
  std::vector<Vec3> points = hills(100);
  points[17][1] = NAN;
  points[5000][2] = INFINITY;
  expect_same(TiledCloud(points, {.tile_points = 2500, .drop_non_finite = true}), 3);
}

TEST(TiledGraph, IsThatOfAnotherNumberOfNeighbours) {
  expect_same(TiledCloud(hills(100), {.tile_points = 2500, .k = 12}), 3);
}

/// The same points as text.
std::string lines_of(const std::vector<Vec3>& points) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : points) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  return text.str();
}

/// Of the same points, whatever the file.
TEST(TiledGraph, IsThatOfAnyKindOfFile) {
  const TiledCloud cloud(hills(60), {.tile_points = 1000});
  const std::string count = std::to_string(cloud.points.size()), text = lines_of(cloud.points),
                    fields = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS " + count + "\nDATA ",
                    bytes(reinterpret_cast<const char*>(cloud.points.data()), cloud.points.size() * sizeof(Vec3));
  const std::map<std::string, std::string> files = {
      {"points.pcd", fields + "binary\n" + bytes},
      {"text.pcd", fields + "ascii\n" + text},
      {"text.ply", "ply\nformat ascii 1.0\nelement vertex " + count +
                       "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" + text},
      {"points.xyz", text},
      {"points.pts", count + "\n" + text}};
  for (const auto& [name, content] : files) {
    const auto input = cloud.folder.directory() / name, tiles = cloud.folder.directory() / ("tiles of " + name);
    std::ofstream(input, std::ios::binary) << content;
    tiles::plan_tiles(input, tiles, {.tile_points = 1000});
    auto expected = contents(cloud.tiles), found = contents(tiles);
    expected.erase("manifest.json"), found.erase("manifest.json");  // they name their inputs
    EXPECT_GT(expected.size(), 3u);
    EXPECT_TRUE(found == expected) << name;
  }
}

TEST(TiledGraph, IsThatOfACloudInOneTile) {
  expect_same(TiledCloud(hills(40), {.tile_points = 100'000}), 1);
  expect_same(TiledCloud(hills(3), {.tile_points = 100}), 1);
}

}  // namespace
}  // namespace ahm::test
