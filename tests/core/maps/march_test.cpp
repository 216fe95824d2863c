// The banded march: the map of the global solve, at any distance, for any graph and source. Streamed maps: the bits of a march that stores
// everything, in memory proportional to the front.
#include "maps/march.hpp"

#include "ahm/fields/vector_heat.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/streamed_log_map.hpp"
#include "core/solved_graph.hpp"
#include "maps/streamed_log_map.hpp"

namespace ahm::test {
namespace {

const HeatOptions global{.strategy = Strategy::global}, marching{.strategy = Strategy::march};

/// A source of three samples with offsets, as for a point inside a face.
Source blended(const TangentGraph& graph) {
  const auto d = to_size(graph.dimension());
  std::vector<double> axes(d * d, 0.0);
  for (std::size_t a = 0; a < d; ++a) axes[a * d + a] = 1;
  const Star star = graph.star(5);
  Source source(graph.dimension());
  source.add(Vertex{5}, 0.5, std::vector<double>(d, 0.0), axes);
  for (std::size_t e = 0; e < 2; ++e) source.add(Vertex(star.neighbors[e]), 0.25, star.log(e), axes);
  return source;
}

TEST(March, AgreesWithTheGlobalSolve) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16)}) {
    const SolvedGraph whole(data, global), march(data, marching);
    for (const Source& source : {source_at(5), blended(whole.graph)})
      for (Variant variant : all_variants) {
        const MapOptions options{.variant = variant, .frames = true};
        const LogMap expected = whole.map(source, options), map = march.map(source, options);
        SCOPED_TRACE(std::to_string(map.march().bands) + " bands");
        EXPECT_EQ(map.strategy(), Strategy::march);
        EXPECT_LT(difference(expected, map), 1e-9);
        expect_near(map.distances(), expected.distances(), 1e-7);
        expect_near(map.frames(), expected.frames(), 1e-6);
      }
  }
}

TEST(March, TakesSeveralBands) {
  const CsrGraphData data = sphere_graph(40000);
  const LogMap map = SolvedGraph(data, marching).map(0);
  EXPECT_GT(map.march().bands, 4);
  EXPECT_LT(map.march().largest_band, 30000);
  EXPECT_LT(difference(SolvedGraph(data, global).map(0), map), 1e-9);
}

TEST(March, HasTheRequestedAccuracyAtAnyDiffusionTime) {
  const CsrGraphData data = sphere_graph(8000);
  const LogMap expected = SolvedGraph(data, global).map(0);
  for (double accuracy : {1e-3, 1e-6, 1e-9, 1e-11}) {
    const LogMap map = SolvedGraph(data, {.strategy = Strategy::march, .accuracy = accuracy}).map(0);
    EXPECT_LT(difference(expected, map), accuracy);
  }
  for (double t_coef : {0.1, 0.5, 4.0, 16.0}) {
    const LogMap a = SolvedGraph(data, {.t_coef = t_coef, .strategy = Strategy::global}).map(3),
                 b = SolvedGraph(data, {.t_coef = t_coef, .strategy = Strategy::march}).map(3);
    EXPECT_LT(difference(a, b), 1e-9) << "t_coef " << t_coef;
  }
}

TEST(March, IsExactOnThePlane) {
  const FlatGraph flat = planar_triangulation(150);
  const SolvedGraph plane(flat.data, marching);
  for (Variant variant : all_variants) {
    const LogMap map = plane.map(77, {.variant = variant});
    EXPECT_GT(map.march().bands, 1);
    EXPECT_EQ(map.count(Status::ok), flat.size());
    expect_exact(flat, map, 77);
  }
}

TEST(March, HasNoHorizon) {
  const SolvedGraph solved(tube(20000, 6), marching);
  for (Variant variant : all_variants) {
    const LogMap map = solved.map(0, {.variant = variant});
    EXPECT_EQ(map.count(Status::ok), map.size());
    for (Index r = 19999; r > 0; r -= 97)
      ASSERT_NEAR(length(map.coordinates(Vertex(6 * r))) / r, 1.0, 1e-3) << "ring " << r;
  }
}

TEST(March, ContinuesWhereTheGlobalSolveEnds) {
  const CsrGraphData data = tube(2000, 6);
  EXPECT_GT(SolvedGraph(data, global).map(0).count(Status::unreached), 0);
  const LogMap map = SolvedGraph(data).map(0);
  EXPECT_EQ(map.strategy(), Strategy::march);
  EXPECT_EQ(map.count(Status::ok), map.size());
  EXPECT_LT(difference(SolvedGraph(data, marching).map(0), map), 1e-9);
}

TEST(March, EndsWhereHeatDistancesAreBeyondAllNumbers) {
  CsrGraphData data = planar_triangulation(60).data;
  for (Index i = 0; i < 3600; ++i)  // no heat flows to vertex 0, so its distance depends on lengths only
    for (Offset e = data.row_begin[i]; e < data.row_begin[i + 1]; ++e)
      if (i == 0 || data.neighbors[e] == 0) data.weights[e] = -std::abs(data.weights[e]);
  for (const double t_coef : {1e-60, 1e-280}) {
    const LogMap map = SolvedGraph(data, {.t_coef = t_coef, .strategy = Strategy::march}).map(7);
    EXPECT_EQ(map.status(Vertex{7}), Status::ok) << t_coef;
    EXPECT_EQ(map.status(Vertex{0}), Status::unreached) << t_coef;
  }
}

TEST(March, StaysInTheComponentsOfItsSources) {
  const FlatGraph flat = planar_triangulation(60);
  const CsrGraphData data = doubled(flat.data);
  const SolvedGraph march(data, marching);
  const LogMap map = march.map(7 + flat.size());
  EXPECT_EQ(map.count(Status::disconnected), flat.size());
  EXPECT_EQ(map.count(Status::ok), flat.size());
  EXPECT_EQ(map.status(Vertex{7}), Status::disconnected);
  Source both(2);
  both.add(Vertex{7}, 1, zero, identity).add(Vertex(9 + flat.size()), 1, Vec2{1, 0}, identity);
  EXPECT_LT(difference(SolvedGraph(data, global).map(both), march.map(both)), 1e-9);
}

TEST(March, EndsAtTheRadius) {
  const SolvedGraph march(planar_triangulation(150).data, marching);
  const LogMap whole = march.map(75), local = march.map(75, {.radius = 0.2});
  EXPECT_LT(local.march().solved, whole.march().solved / 2);
  for (Index i = 0; i < whole.size(); ++i) {
    if (std::abs(whole.distance(Vertex(i)) - 0.2) < 1e-9) continue;
    ASSERT_EQ(local.status(Vertex(i)), whole.distance(Vertex(i)) < 0.2 ? Status::ok : Status::beyond_radius);
    if (local.status(Vertex(i)) == Status::ok)
      expect_near(local.coordinates(Vertex(i)), whole.coordinates(Vertex(i)), 1e-11);
  }
}

// Behind walls the distances of heat are too short at some vertices and too long at others.
TEST(March, ReachesEveryVertexWithinTheRadius) {
  grid::Grid spec{.shape = {41, 41}, .spacing = {1, 1.7}, .blocked = std::vector<std::uint8_t>(40 * 40)};
  for (int k = 0; k < 30; ++k) spec.blocked[40 * 12 + k] = spec.blocked[40 * 27 + 39 - k] = 1;
  const grid::GridGraph graph(spec);
  const LogMapSolver march(graph, marching);
  const LogMap whole = march.solve(source_at(50));
  for (const double radius : {10.0, 25.0, 40.0, 60.0, 80.0}) {
    const LogMap local = march.solve(source_at(50), {.radius = radius});
    for (Index i = 0; i < graph.size(); ++i)
      ASSERT_EQ(local.status(Vertex(i)) == Status::ok, whole.distance(Vertex(i)) <= radius)
          << i << " at " << whole.distance(Vertex(i)) << " within " << radius;
  }
}

TEST(March, DoesNotDependOnThreads) {
  const SolvedGraph march(sphere_graph(20000), marching);
  const std::vector sources{source_at(0), source_at(9), source_at(1000)};
  const auto one = march.solver.solve(sources, {.threads = 1}), four = march.solver.solve(sources, {.threads = 4});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    EXPECT_TRUE(same_bits(one[s].coordinates(), four[s].coordinates()));
    EXPECT_TRUE(same_bits(one[s].coordinates(), march.map(sources[s], {.threads = 2}).coordinates()));
  }
}

/// The fault of a solve; empty: none.
std::string fault(const CsrGraphData& data, const HeatOptions& options, Index source) {
  try {
    SolvedGraph(data, options).map(source);
  } catch (const NotPositiveDefinite& error) {
    return std::string(error.fault());
  }
  return "";
}

TEST(March, RefusesLongDiffusionTimesAsTheGlobalSolveOnAnyNumberOfThreads) {
  const CsrGraphData data = sphere_graph(20000);
  EXPECT_EQ(fault(data, {.t_coef = 1e14, .strategy = Strategy::global, .threads = 1}, 0), "heat_not_conserved");
  for (const unsigned threads : {1u, 2u, 4u})
    EXPECT_EQ(fault(data, {.t_coef = 1e14, .strategy = Strategy::march, .threads = threads}, 0), "heat_not_conserved")
        << threads;
}

/// Weights and masses of a strip up to a column and from that column on.
struct Halves {
  Index column;
  double weights[2], masses[2], t_coef;
};

// A band that loses heat is too thin as well. One thread checks a factor when it is computed, several threads check it later.
TEST(March, RefusesBandsThatAreTooThinOnAnyNumberOfThreads) {
  for (const Halves& halves :
       {Halves{1445, {5.1e14, 8.02e9}, {1, 6.12e5}, 0.00107}, Halves{333, {8.93e12, 2.67e9}, {1, 1.65e5}, 0.00392}}) {
    CsrGraphData data = strip(1900).data;
    const auto half = [&](Index i) { return i / 3 < halves.column ? 0 : 1; };
    for (Index i = 0; i < 5700; ++i) {
      data.masses[i] = halves.masses[half(i)];
      for (Offset e = data.row_begin[i]; e < data.row_begin[i + 1]; ++e)
        data.weights[e] = std::min(halves.weights[half(i)], halves.weights[half(data.neighbors[e])]);
    }
    for (const unsigned threads : {1u, 2u, 3u}) {
      const HeatOptions options{.t_coef = halves.t_coef, .strategy = Strategy::march, .threads = threads};
      EXPECT_EQ(fault(data, options, 1), "heat_not_conserved") << threads;
    }
  }
}

TEST(March, CanBeStopped) {
  std::stop_source stop;
  stop.request_stop();
  const SolvedGraph march(sphere_graph(5000), marching);
  EXPECT_THROW(march.map(0, {.progress = Progress{{}, stop.get_token()}}), Cancelled);
}

TEST(March, FactorsTheOperatorsOfTheWholeGraphWhereMemorySuffices) {
  const CsrGraphData data = sphere_graph(3000);
  const SolvedGraph march(data, marching), whole(data, global), small_memory(data, {.memory = 1 << 20});
  EXPECT_EQ(parallel_transport(march.solver, source_at(4)).values,
            parallel_transport(whole.solver, source_at(4)).values);
  EXPECT_EQ(small_memory.map(4).count(Status::ok), 3000);
  EXPECT_THROW(parallel_transport(small_memory.solver, source_at(4)), ResourceExhausted);
}

TEST(Strategy, IsChosenFromTheNumberOfMapsAndTheMemory) {
  const CsrGraph small(sphere_graph(2000)), large(sphere_graph(60000));
  const auto chosen = [](const TangentGraph& graph, const HeatOptions& options) {
    return LogMapSolver(graph, options).strategy();
  };
  EXPECT_EQ(chosen(small, {.expected_maps = 1}), Strategy::global);
  EXPECT_EQ(chosen(large, {.expected_maps = 1}), Strategy::march);
  EXPECT_EQ(chosen(large, {}), Strategy::global);
  EXPECT_EQ(chosen(large, {.memory = 1 << 20}), Strategy::march);
  EXPECT_EQ(chosen(small, {.strategy = Strategy::march}), Strategy::march);
  EXPECT_THROW(chosen(small, {.accuracy = 0.0}), InvalidArgument);
  EXPECT_THROW(chosen(small, {.expected_maps = -1}), InvalidArgument);
}

TEST(March, TakesMemoryForReachedVerticesOnly) {
  const auto bytes = [](Index side) {
    const grid::GridGraph graph({.shape = {side, side}, .spacing = {1, 1}});
    const ComponentScales scales(graph);
    const ComponentTimes times(scales, 1);
    March march(graph, {}, times, Variant::adaptive, {20}, 1, {});
    const Index center = side / 2 * side + side / 2;
    march.run(source_at(center));
    EXPECT_TRUE(march.accepted(center + 15));
    EXPECT_FALSE(march.accepted(0));
    EXPECT_TRUE(std::isnan(march.coordinates(0)[0]));
    return static_cast<double>(march.bytes());
  };
  const double small = bytes(150), large = bytes(1000);
  // A table of one pointer per 256 vertices, and a page of 256 numbers for each row of the grid that was reached.
  EXPECT_LT(large - small, 1000 * 1000 / 32.0 + 150 * 1024.0);
  EXPECT_LT(large, 1000 * 1000 * 2.0);
}

TEST(March, NumbersVerticesInTheOrderOfArrivalAndReusesForgottenNumbers) {
  ReachedNumbers numbers(1'000'000);
  for (Index vertex : {5, 999'999, 6, 5}) numbers.number(vertex);
  EXPECT_EQ(numbers.count(), 3);
  EXPECT_EQ(numbers.find(5), 0);
  EXPECT_EQ(numbers.find(999'999), 1);
  EXPECT_EQ(numbers.find(7), -1);
  EXPECT_EQ(numbers.find(500'000), -1);

  ReachedNumbers all(600);
  for (Index vertex = 0; vertex < 600; ++vertex) all.number(vertex);
  const std::size_t before = all.bytes();
  for (Index vertex = 256; vertex < 600; ++vertex) all.forget(vertex);
  EXPECT_EQ(all.find(255), 255);
  EXPECT_EQ(all.find(256), ReachedNumbers::forgotten);
  EXPECT_EQ(all.find(599), ReachedNumbers::forgotten);
  EXPECT_LT(all.bytes(), before + 344 * 2 * sizeof(Index) - 2 * 1024);

  ReachedNumbers few(600);
  few.number(3), few.number(4);
  few.forget(3);
  EXPECT_EQ(few.number(500), 0);
  EXPECT_EQ(few.number(501), 2);
  EXPECT_EQ(few.count(), 3);
}

/// A graph whose component has a stored edge length, as streaming requires.
CsrGraph with_edge_length(CsrGraphData data) {
  data.mean_edge_length = CsrGraph(data).mean_edge_length();
  data.component_edge_lengths.assign(data.masses.size(), *data.mean_edge_length);
  return CsrGraph(std::move(data));
}

struct StoredRows final : MapSink {
  explicit StoredRows(const TangentGraph& graph)
      : d(to_size(graph.dimension())),
        count(to_size(graph.size())),
        status(count.size()),
        phi(count.size() * d),
        distance(count.size()),
        spread(count.size()) {}
  void add(Index vertex, const MapRow& row) override {
    ++count[vertex];
    status[vertex] = row.status;
    std::ranges::copy(row.coordinates, phi.begin() + static_cast<std::ptrdiff_t>(vertex * d));
    distance[vertex] = row.distance;
    spread[vertex] = row.spread;
  }
  void expect_each_once() const { EXPECT_EQ(count, std::vector<int>(count.size(), 1)); }

  std::size_t d;
  std::vector<int> count;  ///< number of calls for each vertex
  std::vector<Status> status;
  std::vector<double> phi, distance, spread;
};

CsrGraphData delaunay_sphere() {
  CsrGraphData data = sphere_graph(6000);
  data.is_delaunay = true;  // distances are unfolded
  return data;
}

TEST(StreamedLogMap, HasTheBitsOfAMarchThatStoresEverything) {
  for (const CsrGraphData& data :
       {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16), delaunay_sphere()}) {
    const CsrGraph graph = with_edge_length(data);
    for (Variant variant : all_variants) {
      const LogMap expected = LogMapSolver(graph, marching).solve(source_at(5), {.variant = variant});
      StoredRows rows(graph);
      const MarchStatistics march = stream_log_map(graph, source_at(5), {.variant = variant}, rows);
      EXPECT_EQ(march.bands, expected.march().bands);
      EXPECT_GT(march.bands, 1);
      rows.expect_each_once();
      EXPECT_TRUE(std::ranges::equal(rows.status, expected.status()));
      EXPECT_TRUE(same_bits(rows.phi, expected.coordinates()));
      EXPECT_TRUE(same_bits(rows.distance, expected.distances()));
      EXPECT_TRUE(same_bits(rows.spread, expected.spread()));
    }
  }
}

TEST(StreamedLogMap, OfDistancesOnlyHasThoseOfTheLocalizedMap) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16)}) {
    const CsrGraph graph = with_edge_length(data);
    StoredRows expected(graph), rows(graph);
    const MarchStatistics march = stream_log_map(graph, source_at(5), {.variant = Variant::localized}, expected);
    EXPECT_EQ(stream_distances(graph, source_at(5), {}, rows).bands, march.bands);
    EXPECT_GT(march.bands, 1);
    EXPECT_EQ(rows.count, expected.count);
    EXPECT_EQ(rows.status, expected.status);
    EXPECT_TRUE(same_bits(rows.distance, expected.distance));
    EXPECT_EQ(rows.phi, std::vector<double>(rows.phi.size(), 0.0));
    for (Index i = 0; i < graph.size(); ++i)
      EXPECT_NEAR(rows.spread[i] * rows.spread[i], expected.spread[i] * expected.spread[i], 1e-12);
  }
}

/// Stores the state after one band, or after the next one if that band was too thin. Starts from the stored state.
struct OneBand final : MarchKeeper {
  std::optional<MarchState> begin() override { return state; }
  void end_band(const March& march) override {
    if (!state && march.statistics().bands >= band) state = march.state();
  }
  Index band = 0;
  std::optional<MarchState> state;
};

// From the end of any band on, the rest is the same as without an interruption.
TEST(StreamedLogMap, GoesOnFromTheEndOfAnyBand) {
  for (const CsrGraphData& data : {sphere_graph(10000), as_blocks(sphere_graph(10000)), bent_lattice(16)})
    for (MarchGoal goal : {MarchGoal::map, MarchGoal::distances}) {
      const CsrGraph graph = with_edge_length(data);
      SingleMember team(graph.dimension());
      const auto stream = [&](StoredRows& rows, OneBand* keeper) {
        return team_log_map(graph, source_at(5), {}, {}, rows, team, {.goal = goal, .keeper = keeper});
      };
      StoredRows expected(graph);
      const MarchStatistics march = stream(expected, nullptr);
      ASSERT_GT(march.bands, 2);
      for (Index band = 1; band < march.bands; ++band) {
        OneBand keeper;
        keeper.band = band;
        StoredRows first(graph), second(graph);
        stream(first, &keeper);
        ASSERT_TRUE(keeper.state.has_value());
        if (keeper.state->statistics.bands == march.bands) continue;  // the last
        std::vector<int> before(first.count.size(), 0);
        for (Index vertex : keeper.state->vertices) ++before[vertex];
        const std::vector<Index>& passed = keeper.state->passed;
        for (std::size_t run = 0; run < passed.size(); run += 2)
          for (Index vertex = passed[run]; vertex < passed[run + 1]; ++vertex) ++before[vertex];
        const MarchStatistics resumed = stream(second, &keeper);
        EXPECT_EQ(resumed.bands, march.bands);
        EXPECT_EQ(resumed.solved, march.solved);
        Index after = 0;
        for (Index i = 0; i < graph.size(); ++i) {
          EXPECT_EQ(before[i] + second.count[i], 1);
          if (second.count[i] == 0) continue;
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
  const CsrGraph graph = with_edge_length(sphere_graph(6000));
  const LogMap expected = LogMapSolver(graph, marching).solve(source_at(5), {.radius = 0.5});
  StoredRows rows(graph);
  stream_log_map(graph, source_at(5), {.radius = 0.5}, rows);
  for (Index i = 0; i < graph.size(); ++i)
    EXPECT_EQ(rows.count[i] > 0 && rows.status[i] == Status::ok, expected.status(Vertex(i)) == Status::ok);
  EXPECT_GT(expected.count(Status::ok), 0);
  EXPECT_LT(expected.count(Status::ok), graph.size());
}

TEST(StreamedLogMap, IsCancelledWhileDistancesAreUnfolded) {
  const CsrGraph graph = with_edge_length(delaunay_sphere());
  std::stop_source stop;
  StreamOptions options;
  options.progress.stop = stop.get_token();
  options.progress.report = [&](std::string_view stage, double) {
    EXPECT_EQ(stage, "unfold");
    stop.request_stop();
  };
  StoredRows rows(graph);
  EXPECT_THROW(stream_log_map(graph, source_at(5), options, rows), Cancelled);
  stream_log_map(graph, source_at(5), {}, rows);
  rows.expect_each_once();
}

TEST(StreamedLogMap, RefusesGraphsAndSourcesThatNeedTheWholeGraph) {
  const CsrGraph graph = with_edge_length(sphere_graph(500));
  StoredRows rows(graph);
  EXPECT_THROW(stream_log_map(CsrGraph(sphere_graph(500)), source_at(5), {}, rows), InvalidArgument);
  EXPECT_THROW(stream_log_map(graph, source_at(5), {.radius = 0}, rows), InvalidArgument);
  const Source curve = Source(2).add(Vertex{5}, 1, zero, {}, {.point = 0, .distance = 0});
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
    march.run(source_at(0));
    EXPECT_EQ(count.vertices, graph.size());
    return static_cast<double>(march.bytes());
  };
  EXPECT_LT((bytes(4000) - bytes(1000)) / (3000 * 40), 0.1);  // per vertex
}

}  // namespace
}  // namespace ahm::test
