// Maps by several ranks equal those of one process, whatever tiles the ranks own. The end of one rank ends all.
#include <csignal>
#include <set>
#include <sstream>

#include "programs.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

/// The difference is at most 1e-9 of the largest distance. The spread is the root of a difference of squares, so its squares
/// are compared.
void expect_close(const MapArrays& found, const MapArrays& expected) {
  double farthest = 0;
  for (double r : expected.distance) farthest = std::max(farthest, std::isfinite(r) ? r : 0);
  EXPECT_GT(farthest, 0);
  EXPECT_EQ(found.status, expected.status);
  const auto expect_array = [&](const std::vector<double>& a, const std::vector<double>& b, int power) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
      if (std::isnan(a[i])) continue;
      ASSERT_LE(std::abs(std::pow(a[i], power) - std::pow(b[i], power)), 1e-9 * std::pow(farthest, power)) << i;
    }
  };
  expect_array(found.coordinates, expected.coordinates, 1);
  expect_array(found.distance, expected.distance, 1);
  expect_array(found.spread, expected.spread, 2);
}

void expect_once(const std::string& text, const std::string& part) {
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << text;
  EXPECT_EQ(text.find(part, at + 1), std::string::npos) << text;
}

class MpiTest : public testing::Test {
 protected:
  void SetUp() override {
    if (std::string(AHM_MPI_PROGRAM).empty()) GTEST_SKIP() << "built without ahm-mpi: no PETSc, or no MPI";
  }
};

struct MpiCase {
  const char* name;
  std::vector<Vec3> (*points)();
  Index tile_points;
  std::vector<Row> rows;
  Variant variant;
  std::vector<int> ranks;
  const char* deal;
  double radius = everything;
};

std::vector<Vec3> large_and_small_hills() { return two_hills(70, 30); }
std::vector<Vec3> moebius_points() { return moebius_cloud(6000).points; }

/// Tiles with points of a line only are empty, because such points have no vertices.
std::vector<Vec3> hills_and_a_long_line() {
  std::vector<Vec3> points = hills(30);
  for (int i = 0; i < 900; ++i) points.push_back({4000.0 + i, 0, 0});
  return points;
}

const Row center(70 * 35 + 35);
const MpiCase mpi_cases[] = {
    {"Cards", large_and_small_hills, 400, {center}, Variant::adaptive, {1, 2, 3, 4}, "cards"},
    {"Ranges", large_and_small_hills, 400, {Row(0)}, Variant::localized, {1, 2, 3, 4}, "ranges"},
    {"Reflections", moebius_points, 500, {Row(7)}, Variant::adaptive, {3}, "arrival"},
    {"ReflectionsLocalized", moebius_points, 500, {Row(7)}, Variant::localized, {3}, "arrival"},
    {"SeveralSourcesInTwoComponents",
     large_and_small_hills,
     400,
     {Row(0), Row(70 * 69), Row(70 * 70 + 450)},
     Variant::adaptive,
     {3},
     "arrival"},
    {"Radius", large_and_small_hills, 400, {center}, Variant::adaptive, {2}, "ranges", 20},
    {"MoreRanksThanTiles", [] { return hills(20); }, 2500, {Row(3)}, Variant::adaptive, {3}, "arrival"},
    {"MoreRanksThanVertices",
     [] {
       return std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
     },
     2500,
     {Row(0)},
     Variant::localized,
     {4},
     "arrival"},
    {"EmptyTiles", hills_and_a_long_line, 300, {Row(0)}, Variant::adaptive, {2}, "arrival"}};

class MpiMaps : public MpiTest, public testing::WithParamInterface<MpiCase> {};

TEST_P(MpiMaps, EqualThoseOfOneProcess) {
  const MpiCase& mpi_case = GetParam();
  const TiledCloud cloud(mpi_case.points(), {.tile_points = mpi_case.tile_points});
  const TiledGraph graph = cloud.graph();
  const auto is_empty = [](const tiles::TileFacts& tile) { return tile.vertices == 0; };
  EXPECT_EQ(graph.transport_kind() == TransportKind::block, mpi_case.points == moebius_points);
  EXPECT_EQ(std::ranges::any_of(graph.manifest().tiles, is_empty), mpi_case.points == hills_and_a_long_line);
  const path alone = cloud.file("alone"), together = cloud.file("together");
  std::vector<std::string> words{"logmap", cloud.tiles,   "-o",
                                 together, "--variant",   std::string(to_string(mpi_case.variant)),
                                 "--deal", mpi_case.deal, "--source"};
  std::vector<Vertex> vertices;
  for (Row row : mpi_case.rows) {
    vertices.push_back(graph.vertex_of_row(row).value());
    words.push_back(std::to_string(row.index));
  }
  if (std::isfinite(mpi_case.radius)) words.insert(words.end(), {"--radius", std::to_string(mpi_case.radius)});
  write_log_map(graph, Source::at_vertices(vertices), alone,
                {.heat = {.variant = mpi_case.variant}, .radius = mpi_case.radius});
  for (int ranks : mpi_case.ranks) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    std::filesystem::remove_all(together);
    mpi_output(ranks, words, cloud.file("log"));
    ASSERT_TRUE(std::filesystem::exists(together / "map.json"));
    expect_close(MapArrays(graph, together), MapArrays(graph, alone));
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, MpiMaps, testing::ValuesIn(mpi_cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(MpiTest, OptionsOfPetscApply) {
  const TiledCloud cloud(hills(40), {.tile_points = 400});
  const auto run = [&](const std::vector<std::string>& more, int status) {
    std::vector<std::string> words{"logmap", cloud.tiles, "-o", cloud.file("map")};
    words.insert(words.end(), more.begin(), more.end());
    return mpi_output(2, words, cloud.file("log"), status);
  };
  const auto log = run({"--traffic", "--", "-ksp_view", "-pc_type", "jacobi"}, 0);
  EXPECT_NE(log.find("type: jacobi"), std::string::npos) << log;
  EXPECT_NE(log.find("peak memory, MB: "), std::string::npos) << log;
  const auto failed = run({"--", "-ksp_max_it", "2"}, 1);
  EXPECT_NE(failed.find("DIVERGED_ITS"), std::string::npos) << failed;
}

TEST_F(MpiTest, LocalMapsEqualThoseOfOneProcess) {
  const TiledCloud cloud(hills(60), {.tile_points = 500});
  const TiledGraph graph = cloud.graph();
  const path alone = cloud.file("alone"), together = cloud.file("together");
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 4;
  options.maps.bound_by_straight_line = true;
  options.features = {"count", "curvature"};
  for (std::size_t t = 0; t < graph.tiles(); ++t) write_local_maps(graph, t, alone, options);
  mpi_output(3, {"local-maps", cloud.tiles, "-o", together, "--radius", "4", "--feature", "count", "curvature"},
             cloud.file("log"));
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    const auto expected = read_file(Manifest::file(alone, "local", t));
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(read_file(Manifest::file(together, "local", t)) == expected) << "tile " << t;
  }
}

TEST_F(MpiTest, WithoutCoordinatesDistancesAreThoseOfOneProcessAtLessCost) {
  const TiledCloud cloud(large_and_small_hills(), {.tile_points = 400});
  const TiledGraph graph = cloud.graph();
  const path alone = cloud.file("alone"), together = cloud.file("together");
  const Source source = Source::at_vertex(graph.vertex_of_row(center).value());
  const double near = 1e-9 * write_log_map(graph, source, alone, {.coordinates = false}).farthest;
  for (int ranks : {1, 3}) {
    const auto run = [&](const std::string& command, const path& output) {
      return mpi_output(ranks,
                        {command, cloud.tiles, "-o", output, "--source", std::to_string(center.index), "--traffic"},
                        cloud.file("log"));
    };
    const auto log = run("distance", together), map_log = run("logmap", cloud.file("map"));
    const MapArrays expected(graph, alone, false), found(graph, together, false);
    EXPECT_EQ(found.status, expected.status);
    Index compared = 0;
    for (std::size_t i = 0; i < expected.distance.size(); ++i)
      if (!std::isnan(expected.distance[i])) {
        EXPECT_NEAR(found.distance[i], expected.distance[i], near);
        ++compared;
      }
    EXPECT_EQ(compared, 70 * 70);
    // Sum over the ranks of a number that --traffic prints.
    const auto total = [](const std::string& text, const std::string& name) {
      const auto at = text.find("\n" + name + ": ");
      EXPECT_NE(at, std::string::npos) << text;
      std::istringstream numbers(text.substr(at + name.size() + 3, text.find('\n', at + 1) - at));
      std::int64_t sum = 0;
      for (std::int64_t number = 0; numbers >> number;) sum += number;
      return sum;
    };
    // With A: lambda, two second moments and a test; maps also two coordinates. With B: displacements; maps also frames.
    EXPECT_EQ(7 * total(log, "solves"), 5 * total(map_log, "solves"));
    EXPECT_LT(total(log, "iterations"), total(map_log, "iterations"));
  }
}

TEST_F(MpiTest, ErrorsOfAllRanksArePrintedOnce) {
  const PlannedCloud cloud(hills(20), {.tile_points = 300});
  const path map = cloud.file("map"), log = cloud.file("log");
  expect_once(mpi_output(3, {"logmap", cloud.tiles, "-o", map}, log, 1), "build them first");
  EXPECT_NE(mpi_output(2, {"logmap", cloud.tiles, "-o", map, "--nonsense"}, log, 2).find("--nonsense"),
            std::string::npos);
  cloud.build();
  expect_once(mpi_output(3, {"local-maps", cloud.tiles, "-o", map, "--radius", "3", "--feature", "cuont"}, log, 1),
              "'cuont' is not one of");
}

/// Maps of three ranks from a row of tile 0, with many tiles.
class MpiFaults : public MpiTest {
 protected:
  std::vector<std::string> words() const {
    return {"logmap", cloud.tiles, "-o", map, "--source", std::to_string(cloud.first_row().index)};
  }
  void expect_error_at(const path& file) const {
    const auto output = mpi_output(3, words(), log, 1);
    EXPECT_NE(output.find(file.string()), std::string::npos) << output;
    EXPECT_FALSE(std::filesystem::exists(map / "map.json"));
  }

  const TiledCloud cloud{hills(60), {.tile_points = 300}};
  const path map = cloud.file("map"), log = cloud.file("log");
};

TEST_F(MpiFaults, DamagedTilesEndAllRanks) {
  const path tile = cloud.tile("graph", 7);
  const std::string whole = read_file(tile);
  flip_bit(tile, whole.size() / 2);
  expect_error_at(tile);
  std::filesystem::remove(tile);
  expect_error_at(tile);
  write_file(tile, whole);
  mpi_output(3, words(), log);
  EXPECT_TRUE(std::filesystem::exists(map / "map.json"));
}

/// A folder that is not empty is in the place of a file.
TEST_F(MpiFaults, FilesThatCannotBeWrittenEndAllRanks) {
  std::filesystem::create_directories(Manifest::file(map, "map", 5) / "folder");
  expect_error_at(Manifest::file(map, "map", 5));
}

/// One rank waits forever for a tile, and the others wait for this rank. Then one of the others is killed.
TEST_F(MpiFaults, AKilledRankEndsAllRanks) {
  const BlockedFile tile(cloud.tile("graph", 8));
  Background run = start_mpi(3, words(), log);
  run.wait_for([&] { return run.log().find("solve") != std::string::npos; });
  const std::vector<pid_t> children = run.children();
  ASSERT_EQ(children.size(), 3u);
  ASSERT_EQ(run.wait(std::chrono::seconds(1)), -1) << "no rank reads tile 8: " << run.log();
  ::kill(children[1], SIGKILL);
  EXPECT_GT(run.wait(std::chrono::seconds(60)), 0) << run.log();
  EXPECT_FALSE(std::filesystem::exists(map / "map.json"));
  const auto is_running = [](pid_t process) {  // zombies have ended
    const std::string stat = read_file("/proc/" + std::to_string(process) + "/stat");
    const auto state = stat.rfind(") ");
    return state != std::string::npos && stat[state + 2] != 'Z' && stat[state + 2] != 'X';
  };
  for (int tries = 0; tries < 600 && std::ranges::any_of(children, is_running); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(std::ranges::none_of(children, is_running));
}

/// As many ranks resume from the last checkpoint to the same bytes; another number of ranks, or of tiles per rank, to the
/// same map.
TEST_F(MpiTest, ResumesAfterAKilledRank) {
  const Strip cloud;
  const path whole = cloud.file("whole"), map = cloud.file("map"), log = cloud.file("log");
  const auto words = [&](const path& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{
        "logmap",   cloud.tiles, "-o",           output, "--source", std::to_string(cloud.first_row().index),
        "--memory", "64KB",      "--checkpoint", "1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  mpi_output(3, words(whole), log);
  {
    const BlockedFile tile(cloud.far_tile());
    Background run = start_mpi(3, words(map), log);
    run.wait_for([&] { return std::filesystem::exists(map / "march.json"); });
    ::kill(run.children().at(1), SIGKILL);
    EXPECT_GT(run.wait(std::chrono::seconds(60)), 0) << run.log();
  }
  const auto expect_resumed = [&](int ranks, const std::vector<std::string>& arguments) {
    const auto output = mpi_output(ranks, arguments, log);
    EXPECT_NE(output.find("resumed after band"), std::string::npos) << output;
  };
  const auto names_of = [](const path& folder) {
    std::set<std::string> names;
    for (const auto& [name, bytes] : contents(folder)) names.insert(name);
    return names;
  };
  const TiledGraph graph = cloud.graph();
  for (const auto& [ranks, more] :
       std::vector<std::pair<int, std::vector<std::string>>>{{2, {}}, {4, {"--deal", "ranges"}}, {1, {}}}) {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const path copy = cloud.file("copy for " + std::to_string(ranks));
    std::filesystem::copy(map, copy);
    expect_resumed(ranks, words(copy, more));
    expect_close(MapArrays(graph, copy), MapArrays(graph, whole));
    EXPECT_EQ(names_of(copy), names_of(whole));
  }
  expect_once(mpi_output(2, words(map, {"--t-coef", "2"}), log, 1), "sources or options");
  expect_resumed(3, words(map));
  EXPECT_TRUE(contents(map) == contents(whole));
}

}  // namespace
}  // namespace ahm::test
