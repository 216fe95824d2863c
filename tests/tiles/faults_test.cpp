// Damaged, missing and half-written files, full disks, unsuitable inputs and killed processes: errors name the file, or the
// tiles are right.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "programs.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

/// Six tiles or so, planned or built.
const tiles::TileOptions several_tiles{.tile_points = 1500};

void read_all_stars(const PlannedCloud& cloud) {
  const TiledGraph graph = cloud.graph(1 << 20);
  for (Index i = 0; i < graph.size(); ++i) graph.star(i);
}

void expect_right_graph(const PlannedCloud& cloud, const pointcloud::CloudOptions& options = {}) {
  cloud.build();
  expect_same_graph(cloud.graph(1 << 20), cloud.surface(options));
}

TEST(TileFaults, DamagedTilesAreFound) {
  const TiledCloud cloud(hills(80), several_tiles);
  const auto tile = cloud.tile("graph", 1);
  const auto size = std::filesystem::file_size(tile);
  const auto expect_refusal = [&](const std::string& message) {
    expect_error<IoError>([&] { read_all_stars(cloud); }, message);
  };
  for (std::uintmax_t at : {std::uintmax_t{3}, std::uintmax_t{20}, std::uintmax_t{70}, size / 4, size / 2}) {
    flip_bit(tile, at);
    expect_refusal(tile.string());
    flip_bit(tile, at);
  }
  read_all_stars(cloud);
  for (std::uintmax_t left : {size - 64, std::uintmax_t{10}}) {
    std::filesystem::resize_file(tile, left);
    expect_refusal("truncated");
  }
  std::filesystem::remove(tile);
  expect_refusal(tile.string());
  expect_error<IoError>([&] { cloud.build(); }, "tile 1 in");  // its input was removed
  std::filesystem::copy(cloud.tile("graph", 0), tile);
  expect_refusal("another tile");
}

TEST(TileFaults, DamagedManifestsAreFound) {
  const PlannedCloud cloud(hills(80), several_tiles);
  const auto manifest = cloud.tiles / "manifest.json";
  const auto size = std::filesystem::file_size(manifest);
  for (std::uintmax_t at : {size / 5, size / 2, size - 30}) {
    flip_bit(manifest, at);
    expect_error<IoError>([&] { Manifest::read(cloud.tiles); }, "manifest.json");
    flip_bit(manifest, at);
  }
  std::filesystem::remove(manifest);
  expect_error<IoError>([&] { Manifest::read(cloud.tiles); }, "plan the tiles first");
}

TEST(TileFaults, DamagedIntermediateFilesAreFound) {
  const PlannedCloud cloud(hills(80), several_tiles);
  const auto cut = cloud.tile("cut", 1), points = cloud.tile("points", 1);
  flip_bit(cut, 1000);
  expect_error<IoError>([&] { cloud.build(); }, cut.string());
  flip_bit(cut, 1000);
  for (std::size_t t = 0; t < Manifest::read(cloud.tiles).tiles.size(); ++t) tiles::run_step(cloud.tiles, "sort", t);
  flip_bit(points, 1000);
  expect_error<IoError>([&] { cloud.build(); }, points.string());
  std::filesystem::remove(points);  // as the message suggests
  expect_right_graph(cloud);
}

TEST(TileFaults, StepsRunOnceAndForTilesInAnyOrder) {
  const TiledCloud expected(hills(80), several_tiles);
  const PlannedCloud cloud(hills(80), several_tiles);
  const auto expect_refusal = [&](const char* step, std::optional<std::size_t> tile, const char* message) {
    expect_error<InvalidArgument>([&] { tiles::run_step(cloud.tiles, step, tile); }, message);
  };
  expect_refusal("planes", 0, "planned");
  expect_refusal("index", {}, "run it for tile 0 first");
  expect_refusal("sort", {}, "one tile");
  expect_refusal("sort", 99, "tile 99");
  expect_refusal("sorting", 0, "not one of sort, index");
  const std::size_t tiles = Manifest::read(cloud.tiles).tiles.size();
  for (const tiles::Step& step : tiles::steps()) {
    std::vector<std::optional<std::size_t>> runs;
    for (std::size_t t = step.per_tile ? tiles : 0; t-- > 0;) runs.emplace_back(t);
    if (!step.per_tile) runs.emplace_back(std::nullopt);
    for (const auto& tile : runs) EXPECT_TRUE(tiles::run_step(cloud.tiles, step.name, tile));
    EXPECT_FALSE(tiles::run_step(cloud.tiles, step.name, runs.back()));
  }
  auto a = contents(expected.tiles), b = contents(cloud.tiles);
  a.erase("manifest.json"), b.erase("manifest.json");  // contains the name of the input
  EXPECT_TRUE(a == b);
}

TEST(TileFaults, KilledBuildsResumeToTheSameBytes) {
  const PlannedCloud cloud(hills(80), several_tiles);
  std::filesystem::copy(cloud.tiles, cloud.file("planned"));
  cloud.build();
  const auto expected = contents(cloud.tiles);
  for (int step : {3, 11, 29}) {
    std::filesystem::remove_all(cloud.tiles);
    std::filesystem::copy(cloud.file("planned"), cloud.tiles);
    int kills = 0, status = -1;
    for (int milliseconds = step; status == -1; milliseconds += step) {
      Background build({AHM_TILES_PROGRAM, "build", cloud.tiles, "--threads", "1"}, cloud.file("log"));
      status = build.wait(std::chrono::milliseconds(milliseconds));
      kills += status == -1;
    }
    EXPECT_EQ(status, 0);
    EXPECT_GT(kills, 0);
    EXPECT_TRUE(contents(cloud.tiles) == expected) << step << " ms, killed " << kills << " times";
  }
}

TEST(TileFaults, UnfinishedPlansAreRepeated) {
  const PlannedCloud cloud(hills(80), several_tiles);
  const auto expected = contents(cloud.tiles);
  std::filesystem::remove(cloud.tiles / "manifest.json");  // the last file of a plan
  tiles::plan_tiles(cloud.input, cloud.tiles, several_tiles);
  EXPECT_TRUE(contents(cloud.tiles) == expected);
  expect_error<InvalidArgument>([&] { tiles::plan_tiles(cloud.input, cloud.tiles, {}); }, "already contains tiles");
}

/// Limits the size of new files, as a full disk would.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    rlimit small = limit_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int);
};

TEST(TileFaults, FullDisksAreErrorsAfterWhichTheBuildResumes) {
  const PlannedCloud cloud(hills(80), several_tiles);
  const auto expect_refusal = [&](rlim_t bytes, const auto& work) {
    const FileSizeLimit limit(bytes);
    expect_error<IoError>(work, "cannot write");
  };
  for (rlim_t bytes : {10'000, 100'000, 300'000}) expect_refusal(bytes, [&] { cloud.build(); });
  expect_refusal(10'000, [&] { tiles::plan_tiles(cloud.input, cloud.file("others"), several_tiles); });
  expect_right_graph(cloud);
  const TiledGraph graph = cloud.graph(1 << 20);
  expect_refusal(10'000, [&] { write_log_map(graph, Source::at_vertex(Vertex{0}), cloud.file("map"), {}); });
}

/// Plans and builds the tiles of a file with this name and content.
void tile_file(const std::string& name, const std::string& content, const tiles::TileOptions& options) {
  const TemporaryFolder folder;
  const auto input = folder.directory() / name, tiles = folder.directory() / "tiles";
  if (!content.empty()) write_file(input, content);
  try {
    tiles::plan_tiles(input, tiles, options);
  } catch (const IoError&) {
    EXPECT_FALSE(std::filesystem::exists(tiles));
    throw;
  }
  tiles::build_tiles(tiles);
}

TEST(TileFaults, UnsuitableInputsAreRefused) {
  const std::string with_nan = "0 0 0\n0 1 nan\n1 0 0\n1 1 0\n",
                    with_normals = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n", good = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  struct Refusal {
    std::string content;
    const char* message;
    tiles::TileOptions options = {};
  };
  for (const auto& [content, message, options] :
       {Refusal{"0 0 0\n1 0 0\n", "2 finite points"}, Refusal{"0 0 0\n1 0 0\n0 0 0\n1 0 0\n", "2 distinct"},
        Refusal{"0 0 0\n1 0 0\n2 0 0\n3 0 0\n", "lie on a line"}, Refusal{with_nan, "1 non-finite point in the file"}})
    expect_error<InvalidGeometry>([&] { tile_file("points.xyz", content, options); }, message);
  for (const auto& [content, message, options] :
       {Refusal{with_normals, "normals"}, Refusal{good, "tile_points", {.tile_points = 10}},
        Refusal{good, "k is 2", {.k = 2}}, Refusal{good, "max_edge_ratio", {.max_edge_ratio = 0.5}}})
    expect_error<InvalidArgument>([&] { tile_file("points.xyz", content, options); }, message);
  expect_error<IoError>([&] { tile_file("missing.ply", "", {}); }, "missing.ply");
  expect_error<IoError>([&] { tile_file("points.xyz", "0 0 0\n0 1 x\n", {}); }, "line 2: 'x'");
  tile_file("points.xyz", with_nan, {.drop_non_finite = true});
  tile_file("points.xyz", with_normals, {.ignore_normals = true});
  tile_file("points.xyz", good, {});
  // Binary files are read by another function.
  const PlannedCloud cloud({{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}, {0, 1, 0}}, {.drop_non_finite = true});
  cloud.build();
  expect_error<InvalidGeometry>([&] { tiles::plan_tiles(cloud.input, cloud.file("others"), {}); }, "1 non-finite");
}

TEST(TileFaults, NoiseThatNeedsMoreNeighborsIsAnError) {
  std::vector<Vec3> points = hills(60);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1);
  for (Vec3& p : points) p[2] += noise(random);
  const PlannedCloud cloud(points, several_tiles);
  expect_error<InvalidGeometry>([&] { cloud.build(); }, "k 60");
  expect_right_graph(PlannedCloud(points, {.tile_points = 1500, .k = 60}), {.k = 60, .smooth = 0.0});
}

TEST(TileFaults, TilesThatExceedTheMemoryAreNamed) {
  const PlannedCloud cloud(hills(80), several_tiles);
  expect_error<ResourceExhausted>([&] { tiles::build_tiles(cloud.tiles, {.memory = 1 << 20}); }, "tile 0");
  expect_error<InvalidArgument>([&] { cloud.graph(1 << 20); }, "build them first");
}

/// Errors suggest options of the program, not members of the library.
TEST(TilesProgram, NamesItsOwnOptions) {
  std::vector<Vec3> points = hills(10);
  points[3][0] = NAN;
  const TemporaryFolder folder;
  const auto input = folder.directory() / "points.ply";
  write_points(input, points);
  const std::string command =
      std::string(AHM_TILES_PROGRAM) + " plan " + input.string() + " -o " + (folder.directory() / "tiles").string();
  EXPECT_EQ(output_of(command, 1),
            "ahm-tiles: error: 1 non-finite point in the file; drop such points with --drop-nan\n");
}

/// From 200 MB on the system's loader has what it needs.
TEST(TilesProgram, EndsIfAddressSpaceIsScarce) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more than any limit";
#endif
  const PlannedCloud cloud(hills(80), several_tiles);
  for (const char* kilobytes : {"210000", "260000", "320000"}) {
    const std::string command = std::string("ulimit -v ") + kilobytes + "; timeout 600 " AHM_TILES_PROGRAM " build " +
                                cloud.tiles.string() + "; echo ended $?";
    const std::string output = output_of("(" + command + ")");
    EXPECT_TRUE(output.ends_with("ended 0\n") || output.ends_with("ended 1\n")) << kilobytes << ": " << output;
  }
}

}  // namespace
}  // namespace ahm::test
