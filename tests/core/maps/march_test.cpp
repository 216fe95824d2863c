// The banded march: the same map as the global solve, at any distance, for any graph and source.
#include "maps/march.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

const HeatOptions global{.strategy = Strategy::global}, marching{.strategy = Strategy::march};

/// Largest difference of two maps, relative to the largest distance; infinite where only one is ok.
double difference(const LogMap& a, const LogMap& b) {
  double largest = 0, scale = 0;
  for (Index i = 0; i < a.size(); ++i) {
    if (a.status(Vertex(i)) != b.status(Vertex(i))) return std::numeric_limits<double>::infinity();
    if (a.status(Vertex(i)) != Status::ok) continue;
    scale = std::max(scale, a.distance(Vertex(i)));
    for (int c = 0; c < a.dimension(); ++c)
      largest = std::max(largest, std::abs(a.coordinates(Vertex(i))[c] - b.coordinates(Vertex(i))[c]));
  }
  return largest / scale;
}

/// A source of three samples with offsets, as for a point inside a face.
Source blended(const TangentGraph& graph) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  Source source(graph.dimension());
  std::vector<double> axes(d * d, 0.0), offset(d, 0.0);
  for (std::size_t a = 0; a < d; ++a) axes[a * d + a] = 1;
  const Star star = graph.star(5);
  source.add(Vertex{5}, 0.5, offset, axes);
  for (std::size_t e = 0; e < 2; ++e) {
    for (std::size_t a = 0; a < d; ++a) offset[a] = star.log(e)[a];
    source.add(Vertex(star.neighbors[e]), 0.25, offset, axes);
  }
  return source;
}

TEST(March, AgreesWithTheGlobalSolve) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(6000)), bent_lattice(16)}) {
    const CsrGraph graph(data);
    const LogMapSolver whole(graph, global), march(graph, marching);
    for (const Source& source : {Source::at_vertex(Vertex{5}), blended(graph)})
      for (Variant variant : all_variants) {
        const LogMap expected = whole.solve(source, {.variant = variant}),
                     map = march.solve(source, {.variant = variant});
        EXPECT_EQ(map.strategy(), Strategy::march);
        EXPECT_LT(difference(expected, map), 1e-9) << to_string(variant) << ", " << map.march().bands << " bands";
      }
  }
}

TEST(March, TakesSeveralBands) {
  const CsrGraph graph(sphere_graph(40000));
  const LogMap map = LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex{0}));
  EXPECT_GT(map.march().bands, 4);
  EXPECT_LT(map.march().largest_band, 30000);
  EXPECT_LT(difference(LogMapSolver(graph, global).solve(Source::at_vertex(Vertex{0})), map), 1e-9);
}

TEST(March, IsAsAccurateAsWanted) {
  const CsrGraph graph(sphere_graph(8000));
  const LogMap expected = LogMapSolver(graph, global).solve(Source::at_vertex(Vertex{0}));
  for (double accuracy : {1e-3, 1e-6, 1e-9, 1e-11}) {
    const LogMapSolver march(graph, {.strategy = Strategy::march, .accuracy = accuracy});
    EXPECT_LT(difference(expected, march.solve(Source::at_vertex(Vertex{0}))), accuracy);
  }
}

TEST(March, AgreesAtOtherDiffusionTimes) {
  const CsrGraph graph(sphere_graph(8000));
  for (double t_coef : {0.1, 0.5, 4.0, 16.0}) {
    const LogMap expected =
        LogMapSolver(graph, {.t_coef = t_coef, .strategy = Strategy::global}).solve(Source::at_vertex(Vertex{3}));
    const LogMap map =
        LogMapSolver(graph, {.t_coef = t_coef, .strategy = Strategy::march}).solve(Source::at_vertex(Vertex{3}));
    EXPECT_LT(difference(expected, map), 1e-9) << "t_coef " << t_coef;
  }
}

TEST(March, IsExactOnThePlane) {
  const FlatGraph flat = planar_triangulation(150);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph, marching);
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(Source::at_vertex(Vertex{77}), {.variant = variant});
    EXPECT_GT(map.march().bands, 1);
    for (Index i = 0; i < flat.size(); ++i)
      for (int a = 0; a < 2; ++a)
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], flat.exact(77, i)[a], 1e-11 * flat.diameter()) << "vertex " << i;
  }
}

TEST(March, HasNoHorizon) {
  const CsrGraph graph(tube(20000, 6));
  for (Variant variant : all_variants) {
    const LogMap map = LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex{0}), {.variant = variant});
    EXPECT_EQ(map.count(Status::ok), graph.size());
    const auto away = [&](Index ring) {
      return std::hypot(map.coordinates(Vertex(ring * 6))[0], map.coordinates(Vertex(ring * 6))[1]);
    };
    for (Index r = 1; r < 20000; r += 97) ASSERT_NEAR(away(r) / r, 1.0, 1e-3) << "ring " << r;
    EXPECT_NEAR(away(19999) / 19999, 1.0, 1e-3);
  }
}

TEST(March, GoesOnWhereTheGlobalSolveEnds) {
  const CsrGraph graph(tube(2000, 6));
  const LogMap masked = LogMapSolver(graph, global).solve(Source::at_vertex(Vertex{0}));
  EXPECT_GT(masked.count(Status::unreached), 0);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}));
  EXPECT_EQ(map.strategy(), Strategy::march);
  EXPECT_EQ(map.count(Status::ok), graph.size());
  EXPECT_LT(difference(LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex{0})), map), 1e-9);
}

TEST(March, EndsWhereHeatDistancesAreBeyondAllNumbers) {
  FlatGraph flat = planar_triangulation(60);
  CsrGraphData& data = flat.data;
  for (Index i = 0; i < flat.size(); ++i)  // nothing flows to vertex 0, so that length alone says how far it is
    for (Offset e = data.row_begin[i]; e < data.row_begin[i + 1]; ++e)
      if (i == 0 || data.neighbors[e] == 0) data.weights[e] = -std::abs(data.weights[e]);
  const CsrGraph graph(data);
  for (const double t_coef : {1e-60, 1e-280}) {
    const HeatOptions options{.t_coef = t_coef, .strategy = Strategy::march};
    const LogMap map = LogMapSolver(graph, options).solve(Source::at_vertex(Vertex{7}));
    EXPECT_EQ(map.status(Vertex{7}), Status::ok) << t_coef;
    EXPECT_EQ(map.status(Vertex{0}), Status::unreached) << t_coef;
  }
}

TEST(March, MasksOtherComponents) {
  const FlatGraph flat = planar_triangulation(60);
  const CsrGraph graph(doubled(flat.data));
  const LogMap map = LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex(7 + flat.size())));
  EXPECT_EQ(map.count(Status::disconnected), flat.size());
  EXPECT_EQ(map.count(Status::ok), flat.size());
  EXPECT_EQ(map.status(Vertex{7}), Status::disconnected);
}

TEST(March, TakesSourcesInSeveralComponents) {
  const FlatGraph flat = planar_triangulation(60);
  const CsrGraph graph(doubled(flat.data));
  const std::array zero{0.0, 0.0}, one{1.0, 0.0};
  const std::array identity{1.0, 0.0, 0.0, 1.0};
  Source source(2);
  source.add(Vertex{7}, 1, zero, identity).add(Vertex(9 + flat.size()), 1, one, identity);
  const LogMap expected = LogMapSolver(graph, global).solve(source);
  EXPECT_LT(difference(expected, LogMapSolver(graph, marching).solve(source)), 1e-9);
}

TEST(March, EndsAtTheRadius) {
  const FlatGraph flat = planar_triangulation(150);
  const CsrGraph graph(flat.data);
  const LogMapSolver march(graph, marching);
  const LogMap whole = march.solve(Source::at_vertex(Vertex{75})),
               local = march.solve(Source::at_vertex(Vertex{75}), {.radius = 0.2});
  EXPECT_LT(local.march().solved, whole.march().solved / 2);
  for (Index i = 0; i < graph.size(); ++i) {
    if (std::abs(whole.distance(Vertex(i)) - 0.2) < 1e-9) continue;
    ASSERT_EQ(local.status(Vertex(i)), whole.distance(Vertex(i)) < 0.2 ? Status::ok : Status::beyond_radius);
    if (local.status(Vertex(i)) == Status::ok)
      ASSERT_NEAR(local.coordinates(Vertex(i))[0], whole.coordinates(Vertex(i))[0], 1e-11);
  }
}

/// Behind walls heat tells of shorter ways than there are, and others of longer ones.
TEST(March, ComesToAllThatIsWithinTheRadius) {
  grid::Grid spec{.shape = {41, 41}, .spacing = {1, 1.7}, .blocked = std::vector<std::uint8_t>(40 * 40)};
  for (int k = 0; k < 30; ++k) spec.blocked[40 * 12 + k] = spec.blocked[40 * 27 + 39 - k] = 1;
  const grid::GridGraph graph(spec);
  const Source source = Source::at_vertex(Vertex{50});
  const LogMapSolver march(graph, marching);
  const LogMap whole = march.solve(source);
  for (const double radius : {10.0, 25.0, 40.0, 60.0, 80.0}) {
    const LogMap local = march.solve(source, {.radius = radius});
    for (Index i = 0; i < graph.size(); ++i)
      ASSERT_EQ(local.status(Vertex(i)) == Status::ok, whole.distance(Vertex(i)) <= radius)
          << i << " at " << whole.distance(Vertex(i)) << " within " << radius;
  }
}

TEST(March, DoesNotDependOnThreads) {
  const CsrGraph graph(sphere_graph(20000));
  const LogMapSolver march(graph, marching);
  const std::vector sources{Source::at_vertex(Vertex{0}), Source::at_vertex(Vertex{9}),
                            Source::at_vertex(Vertex{1000})};
  const auto one = march.solve(sources, {.threads = 1}), four = march.solve(sources, {.threads = 4});
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const LogMap single = march.solve(sources[s], {.threads = 2});
    for (std::size_t k = 0; k < one[s].coordinates().size(); ++k) {
      ASSERT_EQ(one[s].coordinates()[k], four[s].coordinates()[k]);
      ASSERT_EQ(one[s].coordinates()[k], single.coordinates()[k]);
    }
  }
}

/// Where the diffusion time is too long for the digits there are.
TEST(March, RefusesTheSameAsTheGlobalSolveOnAnyNumberOfThreads) {
  const CsrGraph graph(sphere_graph(20000));
  const auto told = [&](Strategy strategy, unsigned threads) {
    try {
      LogMapSolver(graph, {.t_coef = 1e14, .strategy = strategy})
          .solve(Source::at_vertex(Vertex{0}), {.threads = threads});
    } catch (const NotPositiveDefinite& error) {
      return std::string(error.fault());
    }
    return std::string("nothing");
  };
  for (const unsigned threads : {1u, 2u, 4u}) EXPECT_EQ(told(Strategy::march, threads), "heat_lost") << threads;
  EXPECT_EQ(told(Strategy::global, 1), "heat_lost");
}

/// What a strip conducts and weighs, up to a column and from there on.
struct Halves {
  Index column;
  double weights[2], masses[2], t_coef;
};

/// A band that loses heat is too thin, too: it counts on one thread, where factors are checked when they are made, and on several,
/// where they are checked later.
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
    const CsrGraph graph(data);
    for (const unsigned threads : {1u, 2u, 3u}) try {
        LogMapSolver(graph, {.t_coef = halves.t_coef, .strategy = Strategy::march, .threads = threads})
            .solve(Source::at_vertex(Vertex{1}));
        ADD_FAILURE() << "a map, on " << threads << " threads";
      } catch (const NotPositiveDefinite& error) {
        EXPECT_EQ(error.fault(), "heat_lost") << threads;
      }
  }
}

TEST(March, CanBeStopped) {
  const CsrGraph graph(sphere_graph(5000));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
      LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex{0}), {.progress = Progress{{}, stop.get_token()}}),
      Cancelled);
}

TEST(March, StillGivesTheOperatorsOfTheWholeGraph) {
  const CsrGraph graph(sphere_graph(3000));
  const LogMapSolver march(graph, marching), whole(graph, global);
  const auto a = parallel_transport(march, Source::at_vertex(Vertex{4})),
             b = parallel_transport(whole, Source::at_vertex(Vertex{4}));
  EXPECT_EQ(a.values, b.values);
}

TEST(March, RefusesFactorsBeyondTheMemory) {
  const CsrGraph graph(sphere_graph(3000));
  const LogMapSolver small_memory(graph, {.memory = 1 << 20});
  EXPECT_EQ(small_memory.solve(Source::at_vertex(Vertex{4})).count(Status::ok), graph.size());
  EXPECT_THROW(parallel_transport(small_memory, Source::at_vertex(Vertex{4})), ResourceExhausted);
}

TEST(Strategy, IsChosenFromTheNumberOfMapsAndTheMemory) {
  const CsrGraph small(sphere_graph(2000)), large(sphere_graph(60000));
  auto chosen = [](const TangentGraph& graph, const HeatOptions& options) {
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

TEST(March, TakesMemoryForWhatItReachesOnly) {
  const auto bytes = [](Index side) {
    const grid::GridGraph graph({.shape = {side, side}, .spacing = {1, 1}});
    const ComponentScales scales(graph);
    const ComponentTimes times(scales, 1);
    March march(graph, {}, times, Variant::adaptive, {20}, 1, {});
    march.run(Source::at_vertex(Vertex{side / 2 * side + side / 2}));
    EXPECT_TRUE(march.accepted(side / 2 * side + side / 2 + 15));
    EXPECT_FALSE(march.accepted(0));
    EXPECT_TRUE(std::isnan(march.coordinates(0)[0]));
    return static_cast<double>(march.bytes());
  };
  const double small = bytes(150), large = bytes(1000);
  // A table of one pointer per 256 vertices, and a page of 256 numbers for each row of the grid that was reached.
  EXPECT_LT(large - small, 1000 * 1000 / 32.0 + 150 * 1024.0);
  EXPECT_LT(large, 1000 * 1000 * 2.0);
}

TEST(March, NumbersVerticesAsTheyCome) {
  ReachedNumbers numbers(1'000'000);
  for (Index vertex : {5, 999'999, 6, 5}) numbers.number(vertex);
  EXPECT_EQ(numbers.count(), 3);
  EXPECT_EQ(numbers.find(5), 0);
  EXPECT_EQ(numbers.find(999'999), 1);
  EXPECT_EQ(numbers.find(7), -1);
  EXPECT_EQ(numbers.find(500'000), -1);
}

TEST(March, GivesTheNumbersOfForgottenVerticesAgain) {
  ReachedNumbers numbers(600);
  for (Index vertex = 0; vertex < 600; ++vertex) numbers.number(vertex);
  const std::size_t before = numbers.bytes();
  for (Index vertex = 256; vertex < 600; ++vertex) numbers.forget(vertex);
  EXPECT_EQ(numbers.find(255), 255);
  EXPECT_EQ(numbers.find(256), ReachedNumbers::forgotten);
  EXPECT_EQ(numbers.find(599), ReachedNumbers::forgotten);
  EXPECT_LT(numbers.bytes(), before + 344 * 2 * sizeof(Index) - 2 * 1024);

  ReachedNumbers few(600);
  few.number(3), few.number(4);
  few.forget(3);
  EXPECT_EQ(few.number(500), 0);
  EXPECT_EQ(few.number(501), 2);
  EXPECT_EQ(few.count(), 3);
}

}  // namespace
}  // namespace ahm::test
