// Sources and options that make no sense are refused with a message that names them.
#include "ahm/maps/source.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/testing/curved_graphs.hpp"
#include "ahm/testing/flat_graphs.hpp"
#include "ahm/testing/graph_changes.hpp"
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
  expect_error<InvalidArgument>([&] { Source::at_vertex(Vertex{1}, zero); }, "direction");
  expect_error<InvalidArgument>([&] { Source::at_vertex(Vertex{1}).add(Vertex{2}, 1.0, zero, identity); },
                                "no further samples");
  expect_error<InvalidArgument>([&] { Source(0); }, "dimension 0");
  EXPECT_TRUE(source.vertices().empty());
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
