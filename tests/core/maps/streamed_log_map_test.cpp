// Maps handed over as the front passes: the bits of a march that keeps everything, in memory that grows with the front.
#include "ahm/maps/streamed_log_map.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "maps/march.hpp"
#include "maps/streamed_log_map.hpp"

namespace ahm::test {
namespace {

/// The same graph, which tells the edge length of its one component.
CsrGraph telling(CsrGraphData data) {
  data.mean_edge_length = CsrGraph(data).mean_edge_length();
  data.component_edge_lengths.assign(data.masses.size(), *data.mean_edge_length);
  return CsrGraph(std::move(data));
}

struct Rows final : MapSink {
  explicit Rows(const TangentGraph& graph)
      : d(static_cast<std::size_t>(graph.dimension())),
        told(static_cast<std::size_t>(graph.size())),
        status(told.size()),
        phi(told.size() * d),
        distance(told.size()),
        spread(told.size()) {}
  void put(Index vertex, const MapRow& row) override {
    ++told[vertex];
    status[vertex] = row.status;
    std::copy(row.coordinates.begin(), row.coordinates.end(), phi.begin() + static_cast<std::ptrdiff_t>(vertex * d));
    distance[vertex] = row.distance;
    spread[vertex] = row.spread;
  }
  std::size_t d;
  std::vector<int> told;
  std::vector<Status> status;
  std::vector<double> phi, distance, spread;
};

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(StreamedLogMap, HasTheBitsOfAMarchThatKeepsEverything) {
  CsrGraphData unfolded = sphere_graph(6000);
  unfolded.is_delaunay = true;
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16), unfolded}) {
    const CsrGraph graph = telling(data);
    const LogMapSolver kept(graph, {.strategy = Strategy::march});
    for (Variant variant : all_variants) {
      const LogMap expected = kept.solve(Source::at_vertex(Vertex{5}), {.variant = variant});
      Rows rows(graph);
      const MarchStatistics march = stream_log_map(graph, Source::at_vertex(Vertex{5}), {.variant = variant}, rows);
      EXPECT_EQ(march.bands, expected.march().bands);
      EXPECT_GT(march.bands, 1);
      EXPECT_EQ(rows.told, std::vector<int>(rows.told.size(), 1));
      EXPECT_TRUE(std::equal(rows.status.begin(), rows.status.end(), expected.status().begin()));
      EXPECT_TRUE(same_bits(rows.phi, expected.coordinates()));
      EXPECT_TRUE(same_bits(rows.distance, expected.distances()));
      EXPECT_TRUE(same_bits(rows.spread, expected.spread()));
    }
  }
}

TEST(StreamedLogMap, DistancesAloneAreThoseOfTheLocalizedMap) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16)}) {
    const CsrGraph graph = telling(data);
    Rows expected(graph), rows(graph);
    const Source source = Source::at_vertex(Vertex{5});
    const MarchStatistics march = stream_log_map(graph, source, {.variant = Variant::localized}, expected);
    const MarchStatistics alone = stream_distances(graph, source, {}, rows);
    EXPECT_EQ(alone.bands, march.bands);
    EXPECT_GT(march.bands, 1);
    EXPECT_EQ(rows.told, expected.told);
    EXPECT_EQ(rows.status, expected.status);
    EXPECT_TRUE(same_bits(rows.distance, expected.distance));
    EXPECT_EQ(rows.phi, std::vector<double>(rows.phi.size(), 0.0));
    for (Index i = 0; i < graph.size(); ++i)
      EXPECT_NEAR(rows.spread[i] * rows.spread[i], expected.spread[i] * expected.spread[i], 1e-12);
  }
}

/// Keeps the state after one band, or the next one where that was too thin, and begins with one.
struct OneBand final : MarchKeeper {
  std::optional<MarchState> begin() override { return state; }
  void end_band(const March& march) override {
    if (!state && march.statistics().bands >= band) state = march.state();
  }
  Index band = 0;
  std::optional<MarchState> state;
};

/// From the end of any band on, all that is left comes out as if the march had never ended.
TEST(StreamedLogMap, GoesOnFromTheEndOfAnyBand) {
  for (const CsrGraphData& data : {sphere_graph(10000), as_blocks(sphere_graph(10000)), bent_lattice(16)})
    for (MarchGoal goal : {MarchGoal::map, MarchGoal::distances}) {
      const CsrGraph graph = telling(data);
      const Source source = Source::at_vertex(Vertex{5});
      Alone alone(graph.dimension());
      Rows expected(graph);
      const MarchStatistics march = team_log_map(graph, source, {}, {}, expected, alone, {.goal = goal});
      ASSERT_GT(march.bands, 2);
      for (Index band = 1; band < march.bands; ++band) {
        OneBand keeper;
        keeper.band = band;
        Rows first(graph), second(graph);
        team_log_map(graph, source, {}, {}, first, alone, {.goal = goal, .keeper = &keeper});
        ASSERT_TRUE(keeper.state.has_value());
        if (keeper.state->statistics.bands == march.bands) continue;  // the last
        std::vector<int> before(first.told.size(), 0);
        for (Index vertex : keeper.state->vertices) ++before[vertex];
        const std::vector<Index>& passed = keeper.state->passed;
        for (std::size_t run = 0; run < passed.size(); run += 2)
          for (Index vertex = passed[run]; vertex < passed[run + 1]; ++vertex) ++before[vertex];
        const MarchStatistics again =
            team_log_map(graph, source, {}, {}, second, alone, {.goal = goal, .keeper = &keeper});
        EXPECT_EQ(again.bands, march.bands);
        EXPECT_EQ(again.solved, march.solved);
        Index after = 0;
        for (Index i = 0; i < graph.size(); ++i) {
          EXPECT_EQ(before[i] + second.told[i], 1);
          if (second.told[i] == 0) continue;
          ++after;
          EXPECT_EQ(second.status[i], expected.status[i]);
          EXPECT_TRUE(same_bits(std::span(&second.distance[i], 1), std::span(&expected.distance[i], 1)));
          EXPECT_TRUE(same_bits(std::span(second.phi).subspan(i * second.d, second.d),
                                std::span(expected.phi).subspan(i * second.d, second.d)));
        }
        EXPECT_GT(after, 0);
        EXPECT_LT(after, graph.size());
      }
    }
}

TEST(StreamedLogMap, EndsAtTheRadius) {
  const CsrGraph graph = telling(sphere_graph(6000));
  const LogMap expected =
      LogMapSolver(graph, {.strategy = Strategy::march}).solve(Source::at_vertex(Vertex{5}), {.radius = 0.5});
  Rows rows(graph);
  stream_log_map(graph, Source::at_vertex(Vertex{5}), {.radius = 0.5}, rows);
  Index ok = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    EXPECT_EQ(rows.told[i] > 0 && rows.status[i] == Status::ok, expected.status(Vertex(i)) == Status::ok);
    ok += expected.status(Vertex(i)) == Status::ok;
  }
  EXPECT_GT(ok, 0);
  EXPECT_LT(ok, graph.size());
}

/// Against rounds of relaxing all edges until nothing changes.
TEST(StreamedLogMap, IsCancelledWhileDistancesAreUnfolded) {
  CsrGraphData data = sphere_graph(6000);
  data.is_delaunay = true;
  const CsrGraph graph = telling(data);
  std::stop_source stop;
  StreamOptions options;
  options.progress.stop = stop.get_token();
  options.progress.report = [&](std::string_view stage, double) {
    EXPECT_EQ(stage, "unfold");
    stop.request_stop();
  };
  Rows rows(graph);
  EXPECT_THROW(stream_log_map(graph, Source::at_vertex(Vertex{5}), options, rows), Cancelled);
  options.progress = {};
  stream_log_map(graph, Source::at_vertex(Vertex{5}), options, rows);
  EXPECT_EQ(rows.told, std::vector<int>(rows.told.size(), 1));
}

TEST(StreamedLogMap, RefusesWhatNeedsTheWholeGraph) {
  const CsrGraph silent(sphere_graph(500)), graph = telling(sphere_graph(500));
  Rows rows(graph);
  const Source source = Source::at_vertex(Vertex{5});
  EXPECT_THROW(stream_log_map(silent, source, {}, rows), InvalidArgument);
  EXPECT_THROW(stream_log_map(graph, source, {.radius = 0}, rows), InvalidArgument);
  Source curve(2);
  curve.add(Vertex{5}, 1, Vec2{0, 0}, {}, {.point = 0, .distance = 0});
  EXPECT_THROW(stream_log_map(graph, curve, {}, rows), InvalidArgument);
}

TEST(StreamedLogMap, ForgetsWhatTheFrontHasPassed) {
  struct Count final : MarchSink {
    void accept(Index, const HeatRow&) override { ++vertices; }
    Offset vertices = 0;
  };
  const auto bytes = [](Index length) {
    const grid::GridGraph graph({.shape = {40, length}, .spacing = {1, 1}});
    const ComponentScales scales(graph);
    const ComponentTimes times(scales, 1);
    Count count;
    March march(graph, {}, times, Variant::adaptive, {}, 1, {}, &count);
    march.run(Source::at_vertex(Vertex{0}));
    EXPECT_EQ(count.vertices, graph.size());
    return static_cast<double>(march.bytes());
  };
  const double per_vertex = (bytes(4000) - bytes(1000)) / (3000 * 40);
  EXPECT_LT(per_vertex, 0.1);
}

}  // namespace
}  // namespace ahm::test
