// A map that was ended, at whatever moment, goes on from its last checkpoint and ends with the bytes of one that was not.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using std::filesystem::path;
using tiles::Manifest;
using tiles::TiledGraph;
using tiles::TiledMapOptions;

struct Strip : TiledCloud {
  Strip() : TiledCloud(strip(), {.tile_points = 400}) { build(); }
};

struct Ended {};

/// Makes the map of row 3 until so many bands are begun; 0: to the end.
tiles::TiledMapSummary make(const TiledCloud& cloud, const path& folder, TiledMapOptions options, Index bands = 0) {
  const TiledGraph graph(cloud.tiles, 1 << 30);
  Index begun = 0;
  options.heat.progress.report = [&](std::string_view stage, double) {
    if (stage == "solve" && ++begun == bands) throw Ended();
  };
  return write_log_map(graph, Source::at_vertex(graph.vertex_of_row(Row(3)).value()), folder, options);
}

std::vector<TiledMapOptions> all_options() {
  std::vector<TiledMapOptions> all(4);
  all[1].heat.variant = Variant::localized;
  all[1].memory = 1 << 14;  // tiles of the map come and go
  all[2].coordinates = false;
  all[3].radius = 330;
  return all;
}

/// Makes the map, ended in each `step`-th band, and what is left of it.
void expect_same_bytes(const TiledCloud& cloud, TiledMapOptions options, Index every, Index step) {
  const auto whole = cloud.folder.directory() / "whole", folder = cloud.folder.directory() / "map";
  const Index bands = make(cloud, whole, options).march.bands;
  ASSERT_GT(bands, 8);
  const auto expected = contents(whole);
  for (const auto& [name, bytes] : expected) EXPECT_TRUE(name == "map.json" || name.ends_with(".map")) << name;
  options.checkpoint = every;
  for (Index band = 1; band <= bands; band += step) {
    EXPECT_THROW(make(cloud, folder, options, band), Ended);
    EXPECT_FALSE(std::filesystem::exists(folder / "map.json"));
    const auto summary = make(cloud, folder, options);
    EXPECT_EQ(summary.begun_at, (band - 1) / every * every);
    EXPECT_EQ(summary.march.bands, bands);
    ASSERT_TRUE(contents(folder) == expected) << "ended in band " << band << ", checkpoints every " << every;
    std::filesystem::remove_all(folder);
  }
  std::filesystem::remove_all(whole);
}

TEST(MapRestart, AfterAnyBandEndsWithTheSameBytes) {
  const Strip cloud;
  expect_same_bytes(cloud, {}, 1, 1);
  for (const TiledMapOptions& options : all_options()) expect_same_bytes(cloud, options, 3, 5);
}

TEST(MapRestart, AgainAndAgainEndsWithTheSameBytes) {
  const Strip cloud;
  const auto whole = cloud.folder.directory() / "whole", folder = cloud.folder.directory() / "map";
  const Index bands = make(cloud, whole, {}).march.bands;
  const TiledMapOptions options{.checkpoint = 2};
  for (Index begun = 0; begun + 4 < bands; begun += 2) {
    EXPECT_THROW(make(cloud, folder, options, 4), Ended);  // three bands, two of which are kept
  }
  EXPECT_GT(make(cloud, folder, options).begun_at, bands / 2);
  EXPECT_TRUE(contents(folder) == contents(whole));
}

/// What is on disk when a checkpoint is half made: tiles that are newer than the record, in any number, and the state of one
/// member or another.
TEST(MapRestart, FromTheMiddleOfACheckpointEndsWithTheSameBytes) {
  const Strip cloud;
  const auto whole = cloud.folder.directory() / "whole", early = cloud.folder.directory() / "early",
             late = cloud.folder.directory() / "late";
  for (const TiledMapOptions& given : all_options()) {
    TiledMapOptions options = given;
    make(cloud, whole, options);
    options.checkpoint = 3;
    for (int take : {1, 2}) {
      EXPECT_THROW(make(cloud, early, options, 5), Ended);
      EXPECT_THROW(make(cloud, late, options, 8), Ended);
      int at = 0;
      for (const auto& entry : std::filesystem::directory_iterator(late)) {
        const auto name = entry.path().filename();
        if (name.extension() == ".front0" || (name.extension() == ".map" && ++at % take == 0))
          std::filesystem::copy(entry.path(), early / name, std::filesystem::copy_options::overwrite_existing);
      }
      EXPECT_EQ(make(cloud, early, options).begun_at, 3);
      EXPECT_TRUE(contents(early) == contents(whole));
      std::filesystem::remove_all(early), std::filesystem::remove_all(late);
    }
    std::filesystem::remove_all(whole);
  }
}

TEST(MapRestart, WithoutCheckpointsBeginsAtTheSource) {
  const Strip cloud;
  const auto folder = cloud.folder.directory() / "map";
  const TiledMapOptions options{.checkpoint = 0};
  EXPECT_THROW(make(cloud, folder, options, 6), Ended);
  EXPECT_FALSE(std::filesystem::exists(folder / "march.json"));
  EXPECT_EQ(make(cloud, folder, options).begun_at, 0);
  EXPECT_EQ(make(cloud, folder, options).begun_at, 0);  // what is finished is made again
  expect_error<InvalidArgument>([&] { make(cloud, folder, {.checkpoint = -1}); }, "checkpoint is -1");
}

TEST(MapRestart, OfAnotherMapIsRefused) {
  const Strip cloud;
  const auto folder = cloud.folder.directory() / "map";
  TiledMapOptions options{.checkpoint = 2};
  EXPECT_THROW(make(cloud, folder, options, 6), Ended);
  const auto kept = contents(folder);
  std::vector<TiledMapOptions> others = all_options();
  others.erase(others.begin());  // that is the same map
  for (const TiledMapOptions& other : others)
    expect_error<InvalidArgument>([&] { make(cloud, folder, other); }, "unfinished map of other tiles, sources or");
  const TiledGraph graph(cloud.tiles, 1 << 30);
  expect_error<InvalidArgument>([&] { write_log_map(graph, Source::at_vertex(Vertex{9}), folder, options); },
                                "remove the folder");
  EXPECT_TRUE(contents(folder) == kept);
  EXPECT_GT(make(cloud, folder, options).begun_at, 0);
}

void flip_bit(const path& name, std::uintmax_t at) {
  std::fstream file(name, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(static_cast<std::streamoff>(at));
  const char byte = static_cast<char>(file.get() ^ 4);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(byte);
}

TEST(MapRestart, FromADamagedCheckpointIsRefused) {
  const Strip cloud;
  const auto folder = cloud.folder.directory() / "map";
  const TiledMapOptions options{.checkpoint = 2};
  EXPECT_THROW(make(cloud, folder, options, 6), Ended);  // two checkpoints: the last in front0
  const auto state = Manifest::file(folder, "front0", 0);
  const auto size = std::filesystem::file_size(state);
  for (std::uintmax_t at : {std::uintmax_t{20}, size / 3, size / 2, size * 3 / 4}) {
    flip_bit(state, at);
    expect_error<IoError>([&] { make(cloud, folder, options); }, state.string());
    flip_bit(state, at);
  }
  std::filesystem::copy(Manifest::file(folder, "front1", 0), state, std::filesystem::copy_options::overwrite_existing);
  expect_error<IoError>([&] { make(cloud, folder, options); }, "belongs to another map");
  std::filesystem::remove(state);
  expect_error<IoError>([&] { make(cloud, folder, options); }, state.string());
  std::ofstream(folder / "march.json") << "{\"version\": 1, \"iden";
  expect_error<IoError>([&] { make(cloud, folder, options); }, "march.json': it is damaged");
}

/// The program waits for ever for a tile, a pipe that nobody writes to, once it has gone past others; then it is killed.
TEST(MapRestart, OfAKilledProgramEndsWithTheSameBytes) {
  const Strip cloud;
  const auto directory = cloud.folder.directory(), whole = directory / "whole", folder = directory / "map",
             log = directory / "log", kept = directory / "kept";
  std::string row;
  path tile;
  {
    const TiledGraph graph(cloud.tiles, 1 << 30);
    row = std::to_string(graph.rows(0).rows[0]);  // for which no other tile is read
    ASSERT_LT(graph.frame(0)->origin[0], 100);
    tile = Manifest::file(cloud.tiles, "graph", graph.tile_of(graph.nearest_vertex({300, 5, 0}).index));
  }
  const auto start = [&](const path& output) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDOUT_FILENO), ::dup2(file, STDERR_FILENO);
    ::execl(AHM_TILES_PROGRAM, "ahm-tiles", "logmap", cloud.tiles.c_str(), "-o", output.c_str(), "--source",
            row.c_str(), "--checkpoint", "2", nullptr);
    ::_exit(127);
  };
  const auto end_of = [](pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  };
  ASSERT_EQ(end_of(start(whole)), 0);
  std::filesystem::rename(tile, kept);
  ASSERT_EQ(::mkfifo(tile.c_str(), 0600), 0);
  for (const int number : {SIGKILL, SIGINT}) {
    std::filesystem::remove_all(folder);
    const pid_t child = start(folder);
    for (int tries = 0; tries < 12'000 && !std::filesystem::exists(folder / "march.json"); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(child, number);
    EXPECT_EQ(end_of(child), number == SIGKILL ? -SIGKILL : 128 + SIGINT);
  }
  for (const auto& [name, bytes] : contents(folder)) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
  std::filesystem::rename(kept, tile);
  ASSERT_EQ(end_of(start(folder)), 0);
  std::ifstream said(log);
  EXPECT_NE(std::string(std::istreambuf_iterator<char>(said), {}).find("resumed after band"), std::string::npos);
  EXPECT_TRUE(contents(folder) == contents(whole));
}

}  // namespace
}  // namespace ahm::test
