// Sources, and the errors about sources and options.
#include "ahm/maps/source.hpp"

#include "core/solved_graph.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

// A number may be a row of the input or a vertex of the graph, and the two differ.
template <class T>
concept MakesASource = requires(T number) {
  Source::at_vertex(number);
};
template <class T>
concept HasCoordinates = requires(const LogMap& map, T number) {
  map.coordinates(number);
};
static_assert(MakesASource<Vertex> && !MakesASource<int> && !MakesASource<Row>);
static_assert(HasCoordinates<Vertex> && !HasCoordinates<int> && !HasCoordinates<Row>);

TEST(SourceAdd, RefusesInvalidArguments) {
  Source source(2);
  const auto expect_refused = [&](double weight, std::vector<double> offset, std::array<double, 4> axes,
                                  const std::string& text) {
    expect_error<InvalidArgument>([&] { source.add(Vertex{4}, weight, offset, axes); }, text);
  };
  expect_refused(-1.0, {0, 0}, identity, "weight -1");
  expect_refused(NAN, {0, 0}, identity, "weight");
  expect_refused(1.0, {0}, identity, "offset");
  expect_refused(1.0, {0, NAN}, identity, "offset");
  expect_refused(1.0, {0, 0}, {1, 0, 0, 2}, "axes");
  const auto add_beside = [&] { source.add(Vertex{4}, 1.0, Vec2{3, 1}, identity, {0, 0.5, {3.0, 0.0}}); };
  expect_error<InvalidArgument>(add_beside, "is 1 from the position of 'place', but its distance is 0.5");
  EXPECT_TRUE(source.vertices().empty());
  expect_error<InvalidArgument>([&] { Source::at_vertex(Vertex{1}, zero); }, "direction");
  expect_error<InvalidArgument>([&] { source_at(1).add(Vertex{2}, 1.0, zero, identity); }, "no more samples");
  expect_error<InvalidArgument>([&] { Source(0); }, "dimension 0");
}

TEST(JoinedSources, ContainTheirPlacesAndRefuseWhatIsNoPoint) {
  Source inside(2);
  inside.add(Vertex{4}, 0.25, Vec2{0.3, 0.4}, mirror).add(Vertex{5}, 0.75, Vec2{-0.1, 0.0}, identity);
  const Source both = Source::joined(std::array{source_at(7), inside});
  EXPECT_FALSE(both.is_curve());
  ASSERT_EQ(both.vertices().size(), 3u);
  EXPECT_EQ(both.vertices()[2], Vertex{5});
  EXPECT_EQ(both.weights()[0], 1.0);
  EXPECT_EQ(both.place(0).point, 0);
  EXPECT_EQ(both.place(1).point, 1);
  EXPECT_DOUBLE_EQ(both.place(1).distance, 0.5);
  EXPECT_EQ(both.axes()[7], -1.0);
  EXPECT_FALSE(Source::joined(std::array{source_at(7), source_at(8)}).dimension());
  const Source curve = Source(2).add(Vertex{1}, 1.0, zero, identity, {0, 0.0});
  expect_error<InvalidArgument>([&] { Source::joined({&curve, 1}); }, "not a point");
  expect_error<InvalidArgument>([&] { Source::joined({&both, 1}); }, "not a point");
  expect_error<InvalidArgument>([&] { Source::joined(std::array{inside, Source(3)}); }, "dimension");
}

// The distances of heat at the vertices of several points are those of the nearest point, also where two points share a vertex.
TEST(JoinedSources, HaveTheDistanceOfTheNearestPoint) {
  const auto point = [](Index vertex, double x) { return Source(2).add(Vertex{vertex}, 1.0, Vec2{-x, 0.0}, identity); };
  const LogMap map = SolvedGraph(planar_triangulation(10).data, {.variant = Variant::localized})
                         .map(Source::joined(std::array{point(44, 0.02), point(44, 0.01), point(77, 0.005)}));
  EXPECT_NEAR(map.distance(Vertex{44}), 0.01, 1e-12);
  EXPECT_NEAR(map.distance(Vertex{77}), 0.005, 1e-12);
}

TEST(PointsInAMap, LieAtTheirOffsets) {
  const FlatGraph flat = planar_triangulation(10);
  const SolvedGraph plane(flat.data);
  const LogMap map = plane.map(12, {.frames = true}), bare = plane.map(12);
  const Vec2 z{0.03, -0.02};
  const auto u = flat.carried(60, 61, {1, 0}), v = flat.carried(60, 61, {0, 1}), to = flat.exact(60, 61);
  Source one(2), two(2);
  one.add(Vertex{60}, 2.0, -z, identity);
  two.add(Vertex{60}, 0.5, -z, identity)
      .add(Vertex{61}, 1.0, Vec2{to[0] - z[0], to[1] - z[1]}, std::array{u[0], v[0], u[1], v[1]});
  const auto there = flat.exact(12, 60), turned = flat.carried(60, 12, {z[0], z[1]});
  for (const Source& point : {one, two}) {
    expect_near(map.coordinates(point), Vec2{there[0] + turned[0], there[1] + turned[1]}, 1e-10);
    expect_error<InvalidArgument>([&] { bare.coordinates(point); }, "frames");
  }
  EXPECT_EQ(bare.coordinates(source_at(60))[0], bare.coordinates(Vertex{60})[0]);
  expect_error<InvalidArgument>([&] { map.coordinates(Source(2)); }, "point");
  const Source in_space = Source(3).add(Vertex{1}, 1.0, Vec3{0, 0, 0});
  expect_error<InvalidArgument>([&] { map.coordinates(in_space); }, "dimension");
}

TEST(SolverArguments, AreCheckedAgainstTheGraph) {
  const SolvedGraph sphere(sphere_graph(60));
  const auto expect_refused = [&](const Source& source, const std::string& text) {
    expect_error<InvalidArgument>([&] { sphere.map(source); }, text);
  };
  expect_refused(source_at(60), "vertex 60 is outside [0, 60)");
  expect_refused(source_at(-1), "vertex -1");
  expect_refused(Source(2), "no vertex");
  expect_refused(Source(3), "dimension 3");
  expect_refused(Source(2).add(Vertex{1}, 0.0, zero, identity), "positive weight");
  expect_refused(Source(2).add(Vertex{1}, 1.0, zero, mirror), "reflection");
  for (double bad : {0.0, -1.0, static_cast<double>(NAN)}) {
    expect_error<InvalidArgument>([&] { sphere.map(0, {.radius = bad}); }, "radius");
    expect_error<InvalidArgument>([&] { LogMapSolver(sphere.graph, {.t_coef = bad}); }, "t_coef");
  }
  expect_error<InvalidArgument>([&] { LogMapSolver(sphere.graph, {.t_coef = INFINITY}); }, "t_coef");
}

TEST(SolverArguments, MayHaveAReflectedFrameOnBlockGraphs) {
  const SolvedGraph sphere(as_blocks(sphere_graph(60)));
  const LogMap map = sphere.map(3), reflected = sphere.map(Source(2).add(Vertex{3}, 1.0, zero, mirror));
  for (Index i = 0; i < map.size(); ++i) {
    const auto z = map.coordinates(Vertex(i));
    expect_near(reflected.coordinates(Vertex(i)), Vec2{z[0], -z[1]}, 1e-12);
  }
}

TEST(SolverArguments, MayHaveWeightsOfAnyScale) {
  const FlatGraph flat = planar_triangulation(6);
  const SolvedGraph plane(flat.data);
  for (double weight : {1e-200, 1.0, 1e200}) {
    const LogMap map = plane.map(Source(2).add(Vertex{3}, weight, zero, identity).add(Vertex{4}, 0.0, zero, identity));
    EXPECT_EQ(map.count(Status::ok), flat.size());
    expect_exact(flat, map, 3);
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
