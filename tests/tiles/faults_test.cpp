// Damaged, missing and half-written files, full disks and killed processes: errors that say which file, or the right tiles.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "said_by.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::Manifest;
using tiles::TiledGraph;

void flip_bit(const std::filesystem::path& path, std::uintmax_t at) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(static_cast<std::streamoff>(at));
  const char byte = static_cast<char>(file.get() ^ 4);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(byte);
}

void go_through(const std::filesystem::path& tiles) {
  const TiledGraph graph(tiles, 1 << 20);
  for (Index i = 0; i < graph.size(); ++i) graph.star(i);
}

TEST(TileFaults, AFlippedBitInATileIsFound) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  cloud.build();
  const auto path = Manifest::file(cloud.tiles, "graph", 1);
  const auto size = std::filesystem::file_size(path);
  for (std::uintmax_t at : {std::uintmax_t{3}, std::uintmax_t{20}, std::uintmax_t{70}, size / 4, size / 2}) {
    flip_bit(path, at);
    expect_error<IoError>([&] { go_through(cloud.tiles); }, path.string());
    flip_bit(path, at);
  }
  go_through(cloud.tiles);
}

TEST(TileFaults, ATileCutShortOrMissingIsNamed) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  cloud.build();
  const auto path = Manifest::file(cloud.tiles, "graph", 1);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 64);
  expect_error<IoError>([&] { go_through(cloud.tiles); }, "truncated");
  std::filesystem::resize_file(path, 10);
  expect_error<IoError>([&] { go_through(cloud.tiles); }, "truncated");
  std::filesystem::remove(path);
  expect_error<IoError>([&] { go_through(cloud.tiles); }, path.string());
  expect_error<IoError>([&] { cloud.build(); }, "tile 1 in");  // what it was made from is gone
  std::filesystem::copy(Manifest::file(cloud.tiles, "graph", 0), path);
  expect_error<IoError>([&] { go_through(cloud.tiles); }, "another tile");
}

TEST(TileFaults, ADamagedManifestIsFound) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  const auto path = cloud.tiles / "manifest.json";
  const auto size = std::filesystem::file_size(path);
  for (std::uintmax_t at : {size / 5, size / 2, size - 30}) {
    flip_bit(path, at);
    expect_error<IoError>([&] { Manifest::read(cloud.tiles); }, "manifest.json");
    flip_bit(path, at);
  }
  std::filesystem::remove(path);
  expect_error<IoError>([&] { Manifest::read(cloud.tiles); }, "plan the tiles first");
}

TEST(TileFaults, ADamagedIntermediateFileIsFound) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  const auto cut = Manifest::file(cloud.tiles, "cut", 1);
  flip_bit(cut, 1000);
  expect_error<IoError>([&] { cloud.build(); }, cut.string());
  flip_bit(cut, 1000);
  for (std::size_t t = 0; t < Manifest::read(cloud.tiles).tiles.size(); ++t) tiles::run_step(cloud.tiles, "sort", t);
  const auto points = Manifest::file(cloud.tiles, "points", 1);
  flip_bit(points, 1000);
  expect_error<IoError>([&] { cloud.build(); }, points.string());
  std::filesystem::remove(points);  // as the error says
  cloud.build();
  expect_same_graph(TiledGraph(cloud.tiles, 1 << 20),
                    pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false}));
}

TEST(TileFaults, StepsGoInAnyOrderOfTilesAndAreDoneOnce) {
  const std::vector<Vec3> points = hills(80);
  TiledCloud expected(points, {.tile_points = 1500}), cloud(points, {.tile_points = 1500});
  expected.build();
  expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, "planes", 0); }, "planned");
  expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, "index", {}); }, "run it for tile 0 first");
  expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, "sort", {}); }, "one tile");
  expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, "sort", 99); }, "tile 99");
  expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, "sorting", 0); }, "not one of sort, index");
  const std::size_t tiles = Manifest::read(cloud.tiles).tiles.size();
  for (const tiles::Step& step : tiles::steps()) {
    if (!step.per_tile) {
      EXPECT_TRUE(tiles::run_step(cloud.tiles, step.name, {}));
      EXPECT_FALSE(tiles::run_step(cloud.tiles, step.name, {}));
      continue;
    }
    for (std::size_t t = tiles; t-- > 0;) EXPECT_TRUE(tiles::run_step(cloud.tiles, step.name, t));
    EXPECT_FALSE(tiles::run_step(cloud.tiles, step.name, 0));
  }
  auto a = contents(expected.tiles), b = contents(cloud.tiles);
  a.erase("manifest.json"), b.erase("manifest.json");  // they name their inputs
  EXPECT_TRUE(a == b);
}

/// Killed at any moment and begun again, until it is done: the same bytes.
TEST(TileFaults, AKilledBuildGoesOnWhereItWas) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  const auto planned = cloud.folder.directory() / "planned";
  std::filesystem::copy(cloud.tiles, planned);
  cloud.build();
  const auto expected = contents(cloud.tiles);
  for (int wait : {3, 11, 29}) {
    std::filesystem::remove_all(cloud.tiles);
    std::filesystem::copy(planned, cloud.tiles);
    bool done = false;
    int kills = 0;
    for (int milliseconds = wait; !done; milliseconds += wait) {
      const pid_t child = ::fork();
      if (child == 0) {
        ::freopen("/dev/null", "w", stderr);
        ::freopen("/dev/null", "w", stdout);
        ::execl(AHM_TILES_PROGRAM, "ahm-tiles", "build", cloud.tiles.c_str(), "--threads", "1", nullptr);
        ::_exit(127);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      ::kill(child, SIGKILL);
      int status = 0;
      ::waitpid(child, &status, 0);
      done = WIFEXITED(status);
      kills += !done;
      if (done) EXPECT_EQ(WEXITSTATUS(status), 0);
    }
    EXPECT_GT(kills, 0);
    const auto found = contents(cloud.tiles);
    EXPECT_TRUE(found == expected) << wait << " ms, killed " << kills << " times";
    for (const auto& [name, bytes] : found) EXPECT_TRUE(expected.contains(name)) << name;
  }
}

TEST(TileFaults, AKilledPlanIsPlannedAnew) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  const auto expected = contents(cloud.tiles);
  std::filesystem::remove(cloud.tiles / "manifest.json");  // written last
  tiles::plan_tiles(cloud.input, cloud.tiles, {.tile_points = 1500});
  EXPECT_TRUE(contents(cloud.tiles) == expected);
  expect_error<InvalidArgument>([&] { tiles::plan_tiles(cloud.input, cloud.tiles, {}); }, "already contains tiles");
}

/// A limit of the file size stands for a full disk.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) {
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    rlimit small = limit_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int);
};

TEST(TileFaults, AFullDiskIsAnErrorAfterWhichTheBuildGoesOn) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  for (rlim_t bytes : {rlim_t{10'000}, rlim_t{100'000}, rlim_t{300'000}}) {
    const SmallFiles limit(bytes);
    expect_error<IoError>([&] { cloud.build(); }, "cannot write");
  }
  {
    const SmallFiles limit(10'000);
    const auto others = cloud.folder.directory() / "others";
    expect_error<IoError>([&] { tiles::plan_tiles(cloud.input, others, {.tile_points = 1500}); }, "cannot write");
  }
  cloud.build();
  expect_same_graph(TiledGraph(cloud.tiles, 1 << 20),
                    pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false}));
  {
    const SmallFiles limit(10'000);
    const TiledGraph graph(cloud.tiles, 1 << 20);
    expect_error<IoError>(
        [&] { write_log_map(graph, Source::at_vertex(Vertex{0}), cloud.folder.directory() / "map", {}); },
        "cannot write");
  }
}

TEST(TileFaults, InputsThatCannotBeTiledAreRefused) {
  const TemporaryFolder folder;
  const auto tiles = folder.directory() / "tiles", input = folder.directory() / "points.ply";
  const auto plan = [&](const tiles::TileOptions& options = {}) {
    std::filesystem::remove_all(tiles);
    tiles::plan_tiles(input, tiles, options);
    tiles::build_tiles(tiles);
  };
  expect_error<IoError>([&] { plan(); }, "points.ply");
  write_points(input, {{0, 0, 0}, {1, 0, 0}});
  expect_error<InvalidGeometry>([&] { plan(); }, "2 finite point(s)");
  write_points(input, {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}});
  expect_error<InvalidGeometry>([&] { plan(); }, "2 distinct");
  write_points(input, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  expect_error<InvalidGeometry>([&] { plan(); }, "lie on a line");
  write_points(input, {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}, {0, 1, 0}});
  expect_error<InvalidGeometry>([&] { plan(); }, "1 non-finite point(s) in the file");
  plan({.drop_non_finite = true});
  const auto text = folder.directory() / "points.xyz";
  const auto plan_text = [&](const std::string& lines, const tiles::TileOptions& options = {}) {
    std::filesystem::remove_all(tiles);
    std::ofstream(text) << lines;
    tiles::plan_tiles(text, tiles, options);
  };
  expect_error<IoError>([&] { plan_text("0 0 0\n0 1 x\n"); }, "line 2: 'x' is not a number");
  EXPECT_FALSE(std::filesystem::exists(tiles));
  expect_error<InvalidGeometry>([&] { plan_text("0 0 0\n0 1 nan\n1 0 0\n1 1 0\n"); },
                                "1 non-finite point(s) in the file");
  plan_text("0 0 0\n0 1 nan\n1 0 0\n1 1 0\n", {.drop_non_finite = true});
  expect_error<InvalidArgument>([&] { plan_text("0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n"); }, "normals");
  plan_text("0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n", {.ignore_normals = true});
  write_points(input, hills(20));
  expect_error<InvalidArgument>([&] { plan({.tile_points = 10}); }, "tile_points");
  expect_error<InvalidArgument>([&] { plan({.k = 2}); }, "k is 2");
  expect_error<InvalidArgument>([&] { plan({.max_edge_ratio = 0.5}); }, "max_edge_ratio");
}

TEST(TileFaults, NoiseThatAsksForMoreNeighboursIsNamed) {
  std::vector<Vec3> points = hills(60);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1);
  for (Vec3& p : points) p[2] += noise(random);
  TiledCloud cloud(points, {.tile_points = 1500});
  expect_error<InvalidGeometry>([&] { cloud.build(); }, "k 60");
  TiledCloud wider(points, {.tile_points = 1500, .k = 60});
  wider.build();
  expect_same_graph(TiledGraph(wider.tiles, 1 << 20),
                    pointcloud::PointCloudSurface::build(points, {}, {.k = 60, .smooth = 0.0, .parts_apart = false}));
}

TEST(TileFaults, ATileThatDoesNotFitIntoMemoryIsNamed) {
  TiledCloud cloud(hills(80), {.tile_points = 1500});
  expect_error<ResourceExhausted>([&] { tiles::build_tiles(cloud.tiles, {.memory = 1 << 20}); }, "tile 0");
  expect_error<InvalidArgument>([&] { TiledGraph(cloud.tiles, 1 << 20); }, "build them first");
}

/// What helps is an option of the program, not a member of the library.
TEST(TilesProgram, NamesItsOwnOptions) {
  std::vector<Vec3> points = hills(10);
  points[3][0] = NAN;
  const TemporaryFolder folder;
  const auto input = folder.directory() / "points.ply";
  write_points(input, points);
  const std::string command =
      std::string(AHM_TILES_PROGRAM) + " plan " + input.string() + " -o " + (folder.directory() / "tiles").string();
  EXPECT_EQ(said_by(command, 1), "ahm-tiles: error: 1 non-finite point(s) in the file; drop them with --drop-nan\n");
}

/// OpenBLAS' own threads then never end. From 200 MB on the system's loader and they have what they need to begin with.
TEST(TilesProgram, EndsWhereAddressSpaceIsScarce) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const TiledCloud cloud(hills(80), {.tile_points = 1500});
  for (const char* kilobytes : {"210000", "260000", "320000"}) {
    const std::string command = std::string("ulimit -v ") + kilobytes + "; timeout 600 " AHM_TILES_PROGRAM " build " +
                                cloud.tiles.string() + "; echo ended $?";
    const std::string said = said_by("(" + command + ")");
    EXPECT_TRUE(said.ends_with("ended 0\n") || said.ends_with("ended 1\n")) << kilobytes << ": " << said;
  }
}

}  // namespace
}  // namespace ahm::test
