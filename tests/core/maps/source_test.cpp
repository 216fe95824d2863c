// Sources and options that make no sense are refused with a message that names them.
#include "ahm/maps/source.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

const std::array identity{1.0, 0.0, 0.0, 1.0};
const std::array mirror{1.0, 0.0, 0.0, -1.0};
const std::array zero{0.0, 0.0};

// A number may be a row of the input or a vertex of the graph, and the two differ.
template <class T>
concept MakesASource = requires(T number) {
  Source::at_vertex(number);
};
template <class T>
concept AsksAMap = requires(const LogMap& map, T number) {
  map.coordinates(number);
};
static_assert(MakesASource<Vertex> && !MakesASource<int> && !MakesASource<Row>);
static_assert(AsksAMap<Vertex> && !AsksAMap<int> && !AsksAMap<Row>);

TEST(SourceAdd, RefusesNonsense) {
  Source source(2);
  expect_error<InvalidArgument>([&] { source.add(Vertex{4}, -1.0, zero, identity); }, "weight -1");
  expect_error<InvalidArgument>([&] { source.add(Vertex{4}, NAN, zero, identity); }, "weight");
  expect_error<InvalidArgument>([&] { source.add(Vertex{4}, 1.0, std::array{0.0}, identity); }, "offset");
  expect_error<InvalidArgument>(
      [&] {
        source.add(Vertex{4}, 1.0, std::array<double, 2>{0.0, NAN}, identity);
      },
      "offset");
  expect_error<InvalidArgument>([&] { source.add(Vertex{4}, 1.0, zero, std::array{1.0, 0.0, 0.0, 2.0}); }, "axes");
  expect_error<InvalidArgument>(
      [&] {
        source.add(Vertex{4}, 1.0, std::array{3.0, 1.0}, identity, {0, 0.5, {3.0, 0.0}});
      },
      "'offset' is 1 from the position of 'place', but its distance is 0.5");
  expect_error<InvalidArgument>([&] { Source::at_vertex(Vertex{1}, zero); }, "direction");
  expect_error<InvalidArgument>([&] { Source::at_vertex(Vertex{1}).add(Vertex{2}, 1.0, zero, identity); },
                                "no more samples");
  expect_error<InvalidArgument>([&] { Source(0); }, "dimension 0");
  EXPECT_TRUE(source.vertices().empty());
}

TEST(JoinedSources, KeepTheirPlacesAndRefuseWhatIsNoPoint) {
  Source inside(2);
  inside.add(Vertex{4}, 0.25, std::array{0.3, 0.4}, mirror).add(Vertex{5}, 0.75, std::array{-0.1, 0.0}, identity);
  const Source both = Source::joined(std::array{Source::at_vertex(Vertex{7}), inside});
  EXPECT_FALSE(both.is_curve());
  ASSERT_EQ(both.vertices().size(), 3u);
  EXPECT_EQ(both.vertices()[2], Vertex{5});
  EXPECT_EQ(both.weights()[0], 1.0);
  EXPECT_EQ(both.place(0).point, 0);
  EXPECT_EQ(both.place(1).point, 1);
  EXPECT_DOUBLE_EQ(both.place(1).distance, 0.5);
  EXPECT_EQ(both.axes()[7], -1.0);
  const std::array plain{Source::at_vertex(Vertex{7}), Source::at_vertex(Vertex{8})};
  EXPECT_FALSE(Source::joined(plain).dimension());
  Source curve(2);
  curve.add(Vertex{1}, 1.0, zero, identity, {0, 0.0});
  expect_error<InvalidArgument>([&] { Source::joined({&curve, 1}); }, "not a point");
  expect_error<InvalidArgument>([&] { Source::joined({&both, 1}); }, "not a point");
  expect_error<InvalidArgument>([&] { Source::joined(std::array{inside, Source(3)}); }, "dimension");
}

/// The nearest of several points counts: distances of heat at their vertices are those given, also where two share one.
TEST(JoinedSources, AreAtTheDistanceOfTheNearestPoint) {
  const FlatGraph flat = planar_triangulation(10);
  const CsrGraph graph(flat.data);
  const auto beside = [](Index vertex, double x) {
    return Source(2).add(Vertex{vertex}, 1.0, std::array{-x, 0.0}, identity);
  };
  const LogMap map = LogMapSolver(graph, {.variant = Variant::localized})
                         .solve(Source::joined(std::array{beside(44, 0.02), beside(44, 0.01), beside(77, 0.005)}));
  EXPECT_NEAR(map.distance(Vertex{44}), 0.01, 1e-12);
  EXPECT_NEAR(map.distance(Vertex{77}), 0.005, 1e-12);
}

TEST(PointsInAMap, LieWhereTheirOffsetsPutThem) {
  const FlatGraph flat = planar_triangulation(10);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const LogMap map = solver.solve(Source::at_vertex(Vertex{12}), {.frames = true});
  const LogMap bare = solver.solve(Source::at_vertex(Vertex{12}));
  const std::vector<double> z{0.03, -0.02};
  const auto u = flat.carried(60, 61, std::vector{1.0, 0.0}), v = flat.carried(60, 61, std::vector{0.0, 1.0});
  const std::array axes{u[0], v[0], u[1], v[1]};
  const auto to = flat.exact(60, 61);
  const std::array offsets{-z[0], -z[1], to[0] - z[0], to[1] - z[1]};
  Source one(2), two(2);
  one.add(Vertex{60}, 2.0, std::span(offsets).first(2), identity);
  two.add(Vertex{60}, 0.5, std::span(offsets).first(2), identity)
      .add(Vertex{61}, 1.0, std::span(offsets).last(2), axes);
  const auto there = flat.exact(12, 60), turned = flat.carried(60, 12, z);
  for (const Source& point : {one, two}) {
    const auto found = map.coordinates(point);
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(found[a], there[a] + turned[a], 1e-10);
    expect_error<InvalidArgument>([&] { bare.coordinates(point); }, "frames");
  }
  EXPECT_EQ(bare.coordinates(Source::at_vertex(Vertex{60}))[0], bare.coordinates(Vertex{60})[0]);
  expect_error<InvalidArgument>([&] { map.coordinates(Source(2)); }, "point");
  expect_error<InvalidArgument>(
      [&] {
        map.coordinates(Source(3).add(Vertex{1}, 1.0, std::array{0.0, 0.0, 0.0}));
      },
      "dimension");
}

TEST(SolverArguments, AreCheckedAgainstTheGraph) {
  const CsrGraph graph(sphere_graph(60));
  const LogMapSolver solver(graph);
  expect_error<InvalidArgument>([&] { solver.solve(Source::at_vertex(Vertex{60})); }, "vertex 60 is outside [0, 60)");
  expect_error<InvalidArgument>([&] { solver.solve(Source::at_vertex(Vertex(-1))); }, "vertex -1");
  expect_error<InvalidArgument>([&] { solver.solve(Source(2)); }, "no vertex");
  expect_error<InvalidArgument>([&] { solver.solve(Source(3)); }, "dimension 3");
  expect_error<InvalidArgument>([&] { solver.solve(Source(2).add(Vertex{1}, 0.0, zero, identity)); },
                                "positive weight");
  expect_error<InvalidArgument>([&] { solver.solve(Source(2).add(Vertex{1}, 1.0, zero, mirror)); }, "reflection");
  for (double radius : {0.0, -1.0, static_cast<double>(NAN)})
    expect_error<InvalidArgument>([&] { solver.solve(Source::at_vertex(Vertex{0}), {.radius = radius}); }, "radius");
  for (double t_coef : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    expect_error<InvalidArgument>([&] { LogMapSolver(graph, {.t_coef = t_coef}); }, "t_coef");
}

TEST(SolverArguments, AllowAReflectedFrameOnBlockGraphs) {
  const CsrGraph graph(as_blocks(sphere_graph(60)));
  const LogMapSolver solver(graph);
  const LogMap map = solver.solve(Source::at_vertex(Vertex{3})),
               reflected = solver.solve(Source(2).add(Vertex{3}, 1.0, zero, mirror));
  for (Index i = 0; i < graph.size(); ++i) {
    EXPECT_NEAR(reflected.coordinates(Vertex(i))[0], map.coordinates(Vertex(i))[0], 1e-12);
    EXPECT_NEAR(reflected.coordinates(Vertex(i))[1], -map.coordinates(Vertex(i))[1], 1e-12);
  }
}

TEST(SolverArguments, IgnoreTheScaleOfTheWeights) {
  const FlatGraph flat = planar_triangulation(6);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  for (double weight : {1e-200, 1.0, 1e200}) {
    const LogMap map =
        solver.solve(Source(2).add(Vertex{3}, weight, zero, identity).add(Vertex{4}, 0.0, zero, identity));
    EXPECT_EQ(map.count(Status::ok), flat.size());
    EXPECT_NEAR(map.coordinates(Vertex{20})[0], flat.exact(3, 20)[0], 1e-11);
  }
}

TEST(Words, OfStatusesAndVariantsAreThoseOfTheFiles) {
  EXPECT_EQ(to_string(Status::ok), "ok");
  EXPECT_EQ(to_string(Status::disconnected), "disconnected");
  EXPECT_EQ(to_string(Status::beyond_radius), "beyond_radius");
  EXPECT_EQ(to_string(Status::unreached), "unreached");
  EXPECT_EQ(to_string(Status::removed), "removed");
  EXPECT_EQ(to_string(Variant::adaptive), "adaptive");
  EXPECT_EQ(to_string(Variant::localized), "localized");
  EXPECT_EQ(to_string(Strategy::global), "global");
}

}  // namespace
}  // namespace ahm::test
