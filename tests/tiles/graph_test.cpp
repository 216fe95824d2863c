// Graphs of tiles have the same edges and bits as the graph of the whole cloud in memory.
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

std::vector<Vec3> islands_of_different_density() {
  std::vector<Vec3> points = hills(120);
  for (const Vec3& p : hills(100, 2)) points.push_back({300 + 2 * p[0], 2 * p[1], 50 + p[2]});
  for (const Vec3& p : hills(80, 3)) points.push_back({0.5 * p[0], 400 + 0.5 * p[1], p[2]});
  for (std::size_t i = 0; i < points.size(); i += 7) points.push_back(points[i]);
  return points;
}

/// Far points have no close neighbors and no vertex.
std::vector<Vec3> hills_and_stray_points() {
  std::vector<Vec3> points = hills(110);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-400, 500);
  for (int i = 0; i < 40; ++i) points.push_back({place(random), place(random), place(random)});
  return points;
}

/// The nearest neighbors lie on a line.
std::vector<Vec3> scan_lines() {
  std::vector<Vec3> points;
  for (int line = 0; line < 40; ++line)
    for (int i = 0; i < 800; ++i) points.push_back({0.05 * i, 1.0 * line, std::sin(0.05 * i / 5)});
  return points;
}

/// Points on a line have no tangent plane.
std::vector<Vec3> hills_and_a_line() {
  std::vector<Vec3> points = hills(70);
  for (int i = 0; i < 4000; ++i) points.push_back({1.0 * i, 300, 0});
  return points;
}

std::vector<Vec3> thin_wall() {
  std::vector<Vec3> points = hills(110);
  for (const Vec3& p : hills(110, 9)) points.push_back({p[0], p[1], p[2] + 2});
  return points;
}

std::vector<Vec3> hills_with_non_finite_points() {
  std::vector<Vec3> points = hills(100);
  points[17][1] = NAN;
  points[5000][2] = INFINITY;
  return points;
}

std::vector<Vec3> moebius_band() { return moebius_cloud(30'000).points; }

struct CloudCase {
  const char* name;
  std::vector<Vec3> (*points)();
  std::size_t least_tiles;
  tiles::TileOptions options = {.tile_points = 2500};
};

const CloudCase cloud_cases[] = {
    {"Hills", [] { return hills(220); }, 15},
    {"RandomSphere", [] { return random_sphere(40'000).points; }, 12},
    {"RegularHills", [] { return hills(150, 1, 0); }, 6},
    {"RegularPlane", [] { return jittered_grid(150, 150, 1, 0); }, 6},  // cocircular neighbors
    {"MoebiusBand", moebius_band, 8},
    {"IslandsOfDifferentDensityWithDuplicates", islands_of_different_density, 10},
    {"StrayPoints", hills_and_stray_points, 4},
    {"ScanLines", scan_lines, 8},
    {"TilesWithoutVertices", hills_and_a_line, 6, {.tile_points = 1000}},
    {"ThinWall", thin_wall, 6},
    {"NonFinitePoints", hills_with_non_finite_points, 3, {.tile_points = 2500, .drop_non_finite = true}},
    {"TwelveNeighbors", [] { return hills(100); }, 3, {.tile_points = 2500, .k = 12}},
    {"OneTile", [] { return hills(40); }, 1, {.tile_points = 100'000}},
    {"NinePoints", [] { return hills(3); }, 1, {.tile_points = 100}}};

class TiledGraphs : public testing::TestWithParam<CloudCase> {};

TEST_P(TiledGraphs, EqualTheGraphInMemory) {
  const auto& [name, points, least_tiles, tile_options] = GetParam();
  const TiledCloud cloud(points(), tile_options);
  const TiledGraph graph = cloud.graph(1 << 22);
  EXPECT_GE(graph.tiles(), least_tiles);
  pointcloud::CloudOptions options;
  if (tile_options.k > 0) options.k = tile_options.k;
  options.drop_non_finite = tile_options.drop_non_finite;
  expect_same_graph(graph, cloud.surface(options));
  if (points == moebius_band) EXPECT_EQ(graph.transport_kind(), TransportKind::block);
  if (points == islands_of_different_density) EXPECT_GT(graph.manifest().components, 2);
  if (points != hills_and_a_line) return;
  const auto is_empty = [](const tiles::TileFacts& tile) { return tile.points > 0 && tile.vertices == 0; };
  EXPECT_TRUE(std::ranges::any_of(graph.manifest().tiles, is_empty));
  EXPECT_EQ(write_log_map(graph, Source::at_vertex(Vertex{0}), cloud.file("map"), {}).ok, graph.size());
  tiles::write_rows(graph, cloud.file("map"), cloud.file("map.csv"));
}

INSTANTIATE_TEST_SUITE_P(Clouds, TiledGraphs, testing::ValuesIn(cloud_cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(TiledGraph, DoesNotDependOnTheFileFormat) {
  const PlannedCloud cloud(hills(60), {.tile_points = 1000});
  std::ostringstream lines;
  lines.precision(17);
  for (const Vec3& p : cloud.points) lines << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  const std::string count = std::to_string(cloud.points.size()), text = lines.str(),
                    fields = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS " + count + "\nDATA ";
  const std::map<std::string, std::string> files = {
      {"points.pcd", fields + "binary\n" + bytes_of(cloud.points)},
      {"text.pcd", fields + "ascii\n" + text},
      {"text.ply", "ply\nformat ascii 1.0\nelement vertex " + count +
                       "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" + text},
      {"points.xyz", text},
      {"points.pts", count + "\n" + text}};
  for (const auto& [name, content] : files) {
    write_file(cloud.file(name), content);
    tiles::plan_tiles(cloud.file(name), cloud.file("tiles of " + name), {.tile_points = 1000});
    auto expected = contents(cloud.tiles), found = contents(cloud.file("tiles of " + name));
    expected.erase("manifest.json"), found.erase("manifest.json");  // contains the name of the input
    EXPECT_GT(expected.size(), 3u);
    EXPECT_TRUE(found == expected) << name;
  }
}

}  // namespace
}  // namespace ahm::test
