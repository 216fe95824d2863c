// Maps by several ranks are those of one process, whoever owns what; and no rank waits for one that is dead.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>

#include "ahm/tiles/tiled_local_maps.hpp"
#include "map_rows.hpp"
#include "ranks.hpp"
#include "tiled_clouds.hpp"

#ifndef AHM_MPI_PROGRAM
#define AHM_MPI_PROGRAM ""
#endif

namespace ahm::test {
namespace {

using std::filesystem::path;
using tiles::ArrayFile;
using tiles::Manifest;
using tiles::TiledGraph;

const std::string program = AHM_MPI_PROGRAM;

class MpiMap : public testing::Test {
 protected:
  void SetUp() override {
    if (program.empty()) GTEST_SKIP() << "built without ahm-mpi: no PETSc, or no MPI";
  }
  static Ranks start(const TiledCloud& cloud, int ranks, std::vector<std::string> words) {
    std::vector<std::string> all{"-n", std::to_string(ranks), program};
    all.insert(all.end(), words.begin(), words.end());
    return Ranks(all, cloud.folder.directory() / "log");
  }
  static std::string run(const TiledCloud& cloud, int ranks, const std::vector<std::string>& words, int expected = 0) {
    Ranks all = start(cloud, ranks, words);
    EXPECT_EQ(all.wait(), expected) << all.log();
    return all.log();
  }

  /// Both maps to 1e-9 of the largest distance. The variance of the map, which is a difference of squares, to that of its square.
  static void expect_same(const MapRows& found, const MapRows& expected) {
    double farthest = 0;
    for (double r : expected.distance) farthest = std::max(farthest, std::isfinite(r) ? r : 0);
    const double near = 1e-9 * farthest;
    EXPECT_EQ(found.status, expected.status);
    const auto worst = [](const std::vector<double>& a, const std::vector<double>& b, const auto& number) {
      double most = a.size() == b.size() ? 0 : INFINITY;
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (!std::isnan(a[i]) || !std::isnan(b[i])) {
          const double difference = std::abs(number(a[i]) - number(b[i]));
          most = std::isnan(difference) ? INFINITY : std::max(most, difference);
        }
      return most;
    };
    const auto same = [](double x) { return x; };
    EXPECT_GT(farthest, 0);
    EXPECT_LE(worst(found.coordinates, expected.coordinates, same), near);
    EXPECT_LE(worst(found.distance, expected.distance, same), near);
    EXPECT_LE(worst(found.spread, expected.spread, [](double x) { return x * x; }), near * farthest);
  }

  /// Makes the map with each number of ranks, and compares it to that of one process.
  static void expect_map_of_one(const TiledCloud& cloud, const std::vector<Row>& rows, Variant variant, double radius,
                                const std::vector<int>& numbers, const std::string& deal = "arrival") {
    const TiledGraph graph(cloud.tiles, 1 << 30);
    std::vector<Vertex> vertices;
    for (Row row : rows) vertices.push_back(graph.vertex_of_row(row).value());
    const auto alone = cloud.folder.directory() / "alone", together = cloud.folder.directory() / "together";
    write_log_map(graph, Source::at_vertices(vertices), alone, {.heat = {.variant = variant}, .radius = radius});
    for (int ranks : numbers) {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      std::filesystem::remove_all(together);
      std::vector<std::string> words{"logmap", cloud.tiles, "-o",
                                     together, "--variant", std::string(to_string(variant)),
                                     "--deal", deal,        "--source"};
      for (Row row : rows) words.push_back(std::to_string(row.index));
      if (std::isfinite(radius)) words.insert(words.end(), {"--radius", std::to_string(radius)});
      run(cloud, ranks, words);
      ASSERT_TRUE(std::filesystem::exists(together / "map.json"));
      expect_same(MapRows(graph, together), MapRows(graph, alone));
    }
  }
};

constexpr double everything = std::numeric_limits<double>::infinity();

TEST_F(MpiMap, IsThatOfOneProcessAdaptive) {
  const TiledCloud cloud(two_hills(70, 30), {.tile_points = 400});
  cloud.build();
  expect_map_of_one(cloud, {Row(70 * 35 + 35)}, Variant::adaptive, everything, {1, 2, 3, 4}, "cards");
}

TEST_F(MpiMap, IsThatOfOneProcessLocalized) {
  const TiledCloud cloud(two_hills(70, 30), {.tile_points = 400});
  cloud.build();
  expect_map_of_one(cloud, {Row(0)}, Variant::localized, everything, {1, 2, 3, 4}, "ranges");
}

TEST_F(MpiMap, IsThatOfOneProcessWithReflections) {
  const TiledCloud cloud(moebius_cloud(6000).points, {.tile_points = 500});
  cloud.build();
  ASSERT_EQ(TiledGraph(cloud.tiles, 1 << 30).transport_kind(), TransportKind::block);
  for (Variant variant : all_variants) expect_map_of_one(cloud, {Row(7)}, variant, everything, {3});
}

TEST_F(MpiMap, HasSeveralSourcesInSeveralComponents) {
  const TiledCloud cloud(two_hills(70, 30), {.tile_points = 400});
  cloud.build();
  expect_map_of_one(cloud, {Row(0), Row(70 * 69), Row(70 * 70 + 450)}, Variant::adaptive, everything, {3});
}

TEST_F(MpiMap, EndsAtARadius) {
  const TiledCloud cloud(two_hills(70, 30), {.tile_points = 400});
  cloud.build();
  expect_map_of_one(cloud, {Row(70 * 35 + 35)}, Variant::adaptive, 20, {2}, "ranges");
}

TEST_F(MpiMap, IsMadeByMoreRanksThanThereAreTiles) {
  const TiledCloud cloud(hills(20), {.tile_points = 2500});
  cloud.build();
  expect_map_of_one(cloud, {Row(3)}, Variant::adaptive, everything, {3});
  const TiledCloud tiny({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});  // fewer vertices than ranks
  tiny.build();
  expect_map_of_one(tiny, {Row(0)}, Variant::localized, everything, {4});
}

/// Points on a line are no surface, hence no vertices: tiles of nothing else are empty.
TEST_F(MpiMap, GoesPastEmptyTiles) {
  std::vector<Vec3> points = hills(30);
  for (int i = 0; i < 900; ++i) points.push_back({4000.0 + i, 0, 0});
  const TiledCloud cloud(points, {.tile_points = 300});
  cloud.build();
  Index empty = 0;
  for (const auto& tile : Manifest::read(cloud.tiles).tiles) empty += tile.vertices == 0;
  ASSERT_GT(empty, 0);
  expect_map_of_one(cloud, {Row(0)}, Variant::adaptive, everything, {2});
}

TEST_F(MpiMap, TakesOptionsOfPetsc) {
  const TiledCloud cloud(hills(40), {.tile_points = 400});
  cloud.build();
  const auto folder = cloud.folder.directory() / "map";
  const auto log =
      run(cloud, 2, {"logmap", cloud.tiles, "-o", folder, "--traffic", "--", "-ksp_view", "-pc_type", "jacobi"});
  EXPECT_NE(log.find("type: jacobi"), std::string::npos) << log;
  EXPECT_NE(log.find("peak memory, MB: "), std::string::npos) << log;
  const auto end = run(cloud, 2, {"logmap", cloud.tiles, "-o", folder, "--", "-ksp_max_it", "2"}, 1);
  EXPECT_NE(end.find("DIVERGED_ITS"), std::string::npos) << end;
}

TEST_F(MpiMap, LocalMapsAreThoseOfOneProcess) {
  const TiledCloud cloud(hills(60), {.tile_points = 500});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto alone = cloud.folder.directory() / "alone", together = cloud.folder.directory() / "together";
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 4;
  options.maps.bound_by_straight_line = true;
  options.features = {"count", "curvature"};
  for (std::size_t t = 0; t < graph.tiles(); ++t) write_local_maps(graph, t, alone, options);
  run(cloud, 3, {"local-maps", cloud.tiles, "-o", together, "--radius", "4", "--feature", "count", "curvature"});
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const auto expected = text_of(Manifest::file(alone, "local", t));
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(text_of(Manifest::file(together, "local", t)) == expected) << "tile " << t;
  }
}

/// A row of tile 0, so that nothing but the march comes to other tiles.
std::string row_of_first_tile(const TiledCloud& cloud) {
  return std::to_string(TiledGraph(cloud.tiles, 1 << 30).rows(0).rows[0]);
}

TEST_F(MpiMap, ADamagedTileEndsAllRanks) {
  const TiledCloud cloud(hills(60), {.tile_points = 300});
  cloud.build();
  const auto row = row_of_first_tile(cloud), map = (cloud.folder.directory() / "map").string();
  const auto tile = Manifest::file(cloud.tiles, "graph", 7);
  const std::string whole = text_of(tile);
  std::string damaged = whole;
  damaged[damaged.size() / 2] ^= 4;
  std::ofstream(tile, std::ios::binary) << damaged;
  auto log = run(cloud, 3, {"logmap", cloud.tiles, "-o", map, "--source", row}, 1);
  EXPECT_NE(log.find(tile.string()), std::string::npos) << log;
  std::filesystem::remove(tile);
  log = run(cloud, 3, {"logmap", cloud.tiles, "-o", map, "--source", row}, 1);
  EXPECT_NE(log.find(tile.string()), std::string::npos) << log;
  EXPECT_FALSE(std::filesystem::exists(path(map) / "map.json"));
  std::ofstream(tile, std::ios::binary) << whole;
  run(cloud, 3, {"logmap", cloud.tiles, "-o", map, "--source", row});
  EXPECT_TRUE(std::filesystem::exists(path(map) / "map.json"));
}

TEST_F(MpiMap, AnErrorOfAllRanksIsSaidOnce) {
  const TiledCloud cloud(hills(20), {.tile_points = 300});  // not built
  const auto log = run(cloud, 3, {"logmap", cloud.tiles, "-o", cloud.folder.directory() / "map"}, 1);
  const auto at = log.find("build them first");
  EXPECT_NE(at, std::string::npos) << log;
  EXPECT_EQ(log.find("build them first", at + 1), std::string::npos) << log;
  EXPECT_NE(run(cloud, 2, {"logmap", cloud.tiles, "-o", "map", "--nonsense"}, 2).find("--nonsense"), std::string::npos);
  cloud.build();
  const auto no_feature = run(
      cloud, 3,
      {"local-maps", cloud.tiles, "-o", cloud.folder.directory() / "map", "--radius", "3", "--feature", "cuont"}, 1);
  const auto first = no_feature.find("'cuont' is not one of");
  EXPECT_NE(first, std::string::npos) << no_feature;
  EXPECT_EQ(no_feature.find("'cuont' is not one of", first + 1), std::string::npos) << no_feature;
}

/// A file that cannot be written: a folder stands in its place, with something in it.
TEST_F(MpiMap, AFileThatCannotBeWrittenEndsAllRanks) {
  const TiledCloud cloud(hills(60), {.tile_points = 300});
  cloud.build();
  const auto row = row_of_first_tile(cloud);
  const auto map = cloud.folder.directory() / "map", place = Manifest::file(map, "map", 5);
  std::filesystem::create_directories(place / "something");
  const auto log = run(cloud, 3, {"logmap", cloud.tiles, "-o", map, "--source", row}, 1);
  EXPECT_NE(log.find(place.string()), std::string::npos) << log;
}

/// Those that nobody has asked for yet how they ended are not.
bool is_alive(pid_t process) {
  const std::string stat = text_of(path("/proc") / std::to_string(process) / "stat");
  const auto state = stat.rfind(") ");
  return state != std::string::npos && stat[state + 2] != 'Z' && stat[state + 2] != 'X';
}

/// One rank waits for ever for a tile, a pipe that nobody writes to, so that the others wait for it; then one of those is killed.
TEST_F(MpiMap, AKilledRankEndsAll) {
  const TiledCloud cloud(hills(60), {.tile_points = 300});
  cloud.build();
  const auto row = row_of_first_tile(cloud);
  const auto tile = Manifest::file(cloud.tiles, "graph", 8);
  std::filesystem::remove(tile);
  ASSERT_EQ(::mkfifo(tile.c_str(), 0600), 0);
  const auto map = cloud.folder.directory() / "map";
  Ranks ranks = start(cloud, 3, {"logmap", cloud.tiles, "-o", map, "--source", row});
  while (ranks.log().find("solve") == std::string::npos) {
    ASSERT_EQ(ranks.wait(std::chrono::seconds(0)), -1) << ranks.log();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const std::vector<pid_t> children = ranks.children();
  ASSERT_EQ(children.size(), 3u);
  ASSERT_EQ(ranks.wait(std::chrono::seconds(1)), -1) << "tile 8 was not asked for: " << ranks.log();
  ::kill(children[1], SIGKILL);
  const int status = ranks.wait(std::chrono::seconds(60));
  EXPECT_GT(status, 0) << ranks.log();
  EXPECT_FALSE(std::filesystem::exists(map / "map.json"));
  for (int tries = 0; tries < 600 && std::any_of(children.begin(), children.end(), is_alive); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(std::none_of(children.begin(), children.end(), is_alive));
}

/// As above; then as many ranks go on from the last checkpoint to the same bytes, and others to the same map.
TEST_F(MpiMap, GoesOnAfterAKilledRank) {
  const TiledCloud cloud(strip(), {.tile_points = 400});
  cloud.build();
  const auto directory = cloud.folder.directory(), whole = directory / "whole", map = directory / "map",
             kept = directory / "kept";
  path tile;
  {
    const TiledGraph graph(cloud.tiles, 1 << 30);
    ASSERT_LT(graph.frame(0)->origin[0], 100);
    tile = Manifest::file(cloud.tiles, "graph", graph.tile_of(graph.nearest_vertex({300, 5, 0}).index));
  }
  const auto words = [&](const path& output) {
    return std::vector<std::string>{
        "logmap",   cloud.tiles, "-o",           output, "--source", row_of_first_tile(cloud),
        "--memory", "64KB",      "--checkpoint", "1"};
  };
  const std::vector<std::string> make = words(map);
  run(cloud, 3, words(whole));
  std::filesystem::rename(tile, kept);
  ASSERT_EQ(::mkfifo(tile.c_str(), 0600), 0);
  {
    Ranks ranks = start(cloud, 3, make);
    for (int tries = 0; tries < 3000 && !std::filesystem::exists(map / "march.json"); ++tries) {
      ASSERT_EQ(ranks.wait(std::chrono::seconds(0)), -1) << ranks.log();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ::kill(ranks.children().at(1), SIGKILL);
    EXPECT_GT(ranks.wait(std::chrono::seconds(60)), 0) << ranks.log();
  }
  std::filesystem::rename(kept, tile);
  // Copies go on by fewer, by more, by as many with other tiles, and by one process: the same map to the accuracy.
  const auto go_on = [&](const std::string& name, int ranks, const std::vector<std::string>& more) {
    const auto copy = directory / name;
    std::filesystem::copy(map, copy);
    std::vector<std::string> here = words(copy);
    here.insert(here.end(), more.begin(), more.end());
    const std::string said = run(cloud, ranks, here);
    EXPECT_NE(said.find("resumed after band"), std::string::npos) << said;
    const TiledGraph graph(cloud.tiles, 1 << 30);
    expect_same(MapRows(graph, copy), MapRows(graph, whole));
    std::set<std::string> names, expected;
    for (const auto& [file, bytes] : contents(copy)) names.insert(file);
    for (const auto& [file, bytes] : contents(whole)) expected.insert(file);
    EXPECT_EQ(names, expected);
  };
  go_on("fewer", 2, {});
  go_on("more", 4, {"--deal", "ranges"});
  go_on("alone", 1, {});
  std::vector<std::string> other = make;
  other.insert(other.end(), {"--t-coef", "2"});
  const auto refused = run(cloud, 2, other, 1);
  const auto at = refused.find("sources or options");
  EXPECT_NE(at, std::string::npos) << refused;
  EXPECT_EQ(refused.find("sources or options", at + 1), std::string::npos) << refused;
  const auto log = run(cloud, 3, make);
  EXPECT_NE(log.find("resumed after band"), std::string::npos) << log;
  EXPECT_TRUE(contents(map) == contents(whole));
}

/// The sum over ranks of a number that `--traffic` tells.
std::int64_t told(const std::string& log, const std::string& what) {
  const auto at = log.find("\n" + what + ": ");
  EXPECT_NE(at, std::string::npos) << log;
  std::istringstream numbers(log.substr(at + what.size() + 3, log.find('\n', at + 1) - at));
  std::int64_t sum = 0;
  for (std::int64_t number = 0; numbers >> number;) sum += number;
  return sum;
}

TEST_F(MpiMap, DistancesAloneAreThoseOfOneProcessForLess) {
  const TiledCloud cloud(two_hills(70, 30), {.tile_points = 400});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory();
  const Vertex source = graph.vertex_of_row(Row(70 * 35 + 35)).value();
  tiles::TiledMapOptions options;
  options.coordinates = false;
  const double near = 1e-9 * write_log_map(graph, Source::at_vertex(source), directory / "alone", options).farthest;
  for (int ranks : {1, 3}) {
    const auto words = [&](const std::string& command, const path& output) {
      return std::vector<std::string>{command, cloud.tiles, "-o", output, "--source", "2485", "--traffic"};
    };
    const auto log = run(cloud, ranks, words("distance", directory / "distance"));
    Index compared = 0;
    for (std::size_t t = 0; t < graph.tiles(); ++t) {
      const ArrayFile a(Manifest::file(directory / "alone", "map", t), "map"),
          b(Manifest::file(directory / "distance", "map", t), "map");
      EXPECT_TRUE(same_bits(a.get<std::uint8_t>("status"), b.get<std::uint8_t>("status")));
      const auto expected = a.get<double>("distance"), found = b.get<double>("distance");
      for (std::size_t i = 0; i < expected.size(); ++i)
        if (!std::isnan(expected[i])) {
          EXPECT_NEAR(found[i], expected[i], near);
          ++compared;
        }
    }
    EXPECT_EQ(compared, 70 * 70);
    const auto map = run(cloud, ranks, words("logmap", directory / "map"));
    // By A lambda, both second moments, and a test of A; the map's two coordinates, too. By B displacements; the map's frames.
    EXPECT_EQ(7 * told(log, "solves"), 5 * told(map, "solves"));
    EXPECT_LT(told(log, "iterations"), told(map, "iterations"));
  }
}

}  // namespace
}  // namespace ahm::test
