// Maps that were ended at any moment resume from the last checkpoint. The result has the bytes of a map that was not ended.
#include <csignal>

#include "programs.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::TiledMapOptions;

class MapRestart : public testing::Test {
 protected:
  /// Writes the map of row 3.
  tiles::TiledMapSummary write(const path& folder, TiledMapOptions options) const {
    const TiledGraph graph = cloud.graph();
    return write_log_map(graph, Source::at_vertex(graph.vertex_of_row(Row(3)).value()), folder, options);
  }
  /// The same, but ends at the start of this band. The first band is 1.
  void interrupt(const path& folder, TiledMapOptions options, Index band) const {
    struct Interruption {};
    options.heat.progress.report = [&](std::string_view stage, double) {
      if (stage == "solve" && --band == 0) throw Interruption();
    };
    EXPECT_THROW(write(folder, options), Interruption);
    EXPECT_FALSE(std::filesystem::exists(folder / "map.json"));
  }
  void expect_refusal(const TiledMapOptions& options, const std::string& message) const {
    expect_error<InvalidArgument>([&] { write(map, options); }, message);
  }

  /// The second spills tiles of the map to disk.
  static std::vector<TiledMapOptions> all_options() {
    std::vector<TiledMapOptions> all(4);
    all[1].heat.variant = Variant::localized;
    all[1].memory = 1 << 14;
    all[2].coordinates = false;
    all[3].radius = 330;
    return all;
  }

  /// Ends the map in each `step`-th band, and resumes it.
  void expect_same_bytes(TiledMapOptions options, Index checkpoint, Index step) const {
    const Index bands = write(whole, options).march.bands;
    ASSERT_GT(bands, 8);
    const auto expected = contents(whole);
    for (const auto& [name, bytes] : expected) EXPECT_TRUE(name == "map.json" || name.ends_with(".map")) << name;
    options.checkpoint = checkpoint;
    for (Index band = 1; band <= bands; band += step) {
      interrupt(map, options, band);
      const auto summary = write(map, options);
      EXPECT_EQ(summary.begun_at, (band - 1) / checkpoint * checkpoint);
      EXPECT_EQ(summary.march.bands, bands);
      ASSERT_TRUE(contents(map) == expected) << "ended in band " << band << ", checkpoint every " << checkpoint;
      std::filesystem::remove_all(map);
    }
    std::filesystem::remove_all(whole);
  }

  const Strip cloud;
  const path whole = cloud.file("whole"), map = cloud.file("map");
};

TEST_F(MapRestart, ResumesAfterAnyBand) {
  expect_same_bytes({}, 1, 1);
  for (const TiledMapOptions& options : all_options()) expect_same_bytes(options, 3, 5);
}

TEST_F(MapRestart, ResumesManyTimes) {
  const Index bands = write(whole, {}).march.bands;
  const TiledMapOptions options{.checkpoint = 2};
  for (Index begun = 0; begun + 4 < bands; begun += 2) interrupt(map, options, 4);  // each run stores two bands
  EXPECT_GT(write(map, options).begun_at, bands / 2);
  EXPECT_TRUE(contents(map) == contents(whole));
}

/// The record of the last checkpoint, with all or half of the files of the next: tiles of the map and one of the states.
TEST_F(MapRestart, ResumesFromAnIncompleteCheckpoint) {
  const path early = cloud.file("early"), late = cloud.file("late");
  for (TiledMapOptions options : all_options()) {
    write(whole, options);
    options.checkpoint = 3;
    for (int every : {1, 2}) {
      interrupt(early, options, 5);
      interrupt(late, options, 8);
      int tiles = 0;
      for (const auto& entry : std::filesystem::directory_iterator(late)) {
        const auto name = entry.path().filename();
        if (name.extension() == ".front0" || (name.extension() == ".map" && ++tiles % every == 0))
          copy_over(entry.path(), early / name);
      }
      EXPECT_EQ(write(early, options).begun_at, 3);
      EXPECT_TRUE(contents(early) == contents(whole));
      std::filesystem::remove_all(early), std::filesystem::remove_all(late);
    }
    std::filesystem::remove_all(whole);
  }
}

TEST_F(MapRestart, WithoutCheckpointsStartsAtTheSource) {
  const TiledMapOptions options{.checkpoint = 0};
  interrupt(map, options, 6);
  EXPECT_FALSE(std::filesystem::exists(map / "march.json"));
  EXPECT_EQ(write(map, options).begun_at, 0);
  EXPECT_EQ(write(map, options).begun_at, 0);  // finished maps are written again
  expect_refusal({.checkpoint = -1}, "checkpoint is -1");
}

TEST_F(MapRestart, RefusesCheckpointsOfAnotherMap) {
  const TiledMapOptions options{.checkpoint = 2};
  interrupt(map, options, 6);
  const auto kept = contents(map);
  const std::vector<TiledMapOptions> all = all_options();
  for (const TiledMapOptions& other : std::span(all).subspan(1)) expect_refusal(other, "sources or options");
  expect_error<InvalidArgument>([&] { write_log_map(cloud.graph(), Source::at_vertex(Vertex{9}), map, options); },
                                "remove the folder");
  EXPECT_TRUE(contents(map) == kept);
  EXPECT_GT(write(map, options).begun_at, 0);
}

TEST_F(MapRestart, RefusesDamagedCheckpoints) {
  const TiledMapOptions options{.checkpoint = 2};
  interrupt(map, options, 6);  // two checkpoints; the last is in front0
  const auto state = Manifest::file(map, "front0", 0);
  const auto expect_io_error = [&](const std::string& message) {
    expect_error<IoError>([&] { write(map, options); }, message);
  };
  const auto size = std::filesystem::file_size(state);
  for (std::uintmax_t at : {std::uintmax_t{20}, size / 3, size / 2, size * 3 / 4}) {
    flip_bit(state, at);
    expect_io_error(state.string());
    flip_bit(state, at);
  }
  copy_over(Manifest::file(map, "front1", 0), state);
  expect_io_error("another map");
  std::filesystem::remove(state);
  expect_io_error(state.string());
  write_file(map / "march.json", "{\"version\": 1, \"iden");
  expect_io_error("march.json': it is damaged");
}

/// The program waits forever for a tile after the first checkpoint. Then a signal ends it.
TEST_F(MapRestart, ResumesAfterSignals) {
  const auto start = [&](const path& folder) {
    return Background({AHM_TILES_PROGRAM, "logmap", cloud.tiles, "-o", folder, "--source",
                       std::to_string(cloud.first_row().index), "--checkpoint", "2"},
                      cloud.file("log"));
  };
  ASSERT_EQ(start(whole).wait(), 0);
  {
    const BlockedFile tile(cloud.far_tile());
    for (const int signal : {SIGKILL, SIGINT}) {
      std::filesystem::remove_all(map);
      Background run = start(map);
      run.wait_for([&] { return std::filesystem::exists(map / "march.json"); });
      ::kill(run.process(), signal);
      EXPECT_EQ(run.wait(), 128 + signal);
    }
  }
  for (const auto& [name, bytes] : contents(map)) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
  Background run = start(map);
  ASSERT_EQ(run.wait(), 0);
  EXPECT_NE(run.log().find("resumed after band"), std::string::npos) << run.log();
  EXPECT_TRUE(contents(map) == contents(whole));
}

}  // namespace
}  // namespace ahm::test
