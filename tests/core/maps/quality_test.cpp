// The frames of a map, and the quality that is computed from them.
#include "ahm/maps/quality.hpp"

#include "ahm/fields/vector_heat.hpp"
#include "core/solved_graph.hpp"

namespace ahm::test {
namespace {

TEST(MapFrames, AreTheParallelTransportOfTheSourcesAxes) {
  const SolvedGraph sphere(sphere_graph(3000), {.strategy = Strategy::global});
  expect_near(sphere.map(5, {.frames = true}).frames(), parallel_transport(sphere.solver, source_at(5)).values, 1e-12);
  EXPECT_TRUE(sphere.map(0).frames().empty());
}

TEST(MapQuality, IsOneOnFlatGraphs) {
  for (const FlatGraph& flat : {planar_triangulation(40), lattice3(9), mirrored_plane(20)}) {
    const SolvedGraph solved(flat.data);
    const Source source = source_at(flat.size() / 2 + 3);
    const LogMap map = solved.map(source, {.frames = true});
    const std::vector<double> quality = map_quality(solved.graph, map);
    Wavefront front(solved.graph);
    front.add(source);
    front.run();
    int straight = 0;  // other geodesic paths bend around notches of the boundary
    for (Index i = 0; i < flat.size(); ++i) {
      if (front.distance(Vertex(i)) > (1 + 1e-9) * map.distance(Vertex(i))) continue;
      ++straight;
      ASSERT_NEAR(quality[i], 1.0, 1e-6) << i;
    }
    EXPECT_GT(straight, 0.9 * flat.size());
  }
}

// On a tube the cut locus is the line opposite to the source: the map jumps from one side to the other.
TEST(MapQuality, IsLowAtTheCutLocus) {
  const Index around = 60, rings = 121;
  const SolvedGraph solved(tube(rings, around));
  const std::vector<double> quality = map_quality(solved.graph, solved.map(60 * around, {.frames = true}));
  for (Index r = 0; r < rings; ++r) {
    SCOPED_TRACE(r);
    // The angle between the two geodesic paths to the line decreases with the distance along the tube.
    if (std::abs(r - 60) <= 15) EXPECT_LT(quality[r * around + around / 2], reliable_quality);
    EXPECT_GT(quality[r * around + around / 4], 0.99);
    EXPECT_GT(quality[r * around], 0.99);
  }
}

TEST(MapQuality, IsTheSameByAReferenceFrontMadeWithoutTheMap) {
  CsrGraphData data = tube(61, 60);
  data.is_delaunay = false;
  const SolvedGraph solved(data);
  const Source source = source_at(30 * 60);
  for (const double radius : {static_cast<double>(INFINITY), 10 * solved.graph.mean_edge_length()}) {
    const LogMap map = solved.map(source, {.radius = radius});
    const ReferenceFront front(solved.graph, source, radius);
    ASSERT_NE(front.get(), nullptr);
    const std::vector<double> expected = map_quality(solved.graph, map),
                              found = map_quality(solved.graph, map, front, 2);
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_TRUE(found[i] == expected[i] || (std::isnan(found[i]) && std::isnan(expected[i]))) << "vertex " << i;
  }
  data.is_delaunay = true;
  EXPECT_EQ(ReferenceFront(CsrGraph(data), source).get(), nullptr);
}

TEST(MapQuality, IsNanWhereTheMapIs) {
  const FlatGraph flat = planar_triangulation(20);
  const SolvedGraph two(doubled(flat.data));
  const LogMap map = two.map(0, {.radius = 0.5, .frames = true});
  const std::vector<double> quality = map_quality(two.graph, map);
  for (Index i = 0; i < map.size(); ++i) ASSERT_EQ(std::isnan(quality[i]), map.status(Vertex(i)) != Status::ok);
  EXPECT_GT(map.count(Status::beyond_radius), 0);
  EXPECT_EQ(map.count(Status::disconnected), flat.size());
}

TEST(MapQuality, RefusesOtherGraphsAndCurvesInSpace) {
  const CsrGraph other(sphere_graph(300));
  EXPECT_THROW(map_quality(other, SolvedGraph(sphere_graph(200)).map(0)), InvalidArgument);
  const SolvedGraph space(lattice3(6).data);
  const Source curve = Source(3).add(Vertex{3}, 1, Vec3{0, 0, 0}, {}, {0, 0.0});
  EXPECT_THROW(map_quality(space.graph, space.map(curve)), InvalidArgument);
}

TEST(ReliableDistance, IsTheFarthestWithAtMostOneOfTwentyBelow) {
  std::vector<double> distances, quality;
  for (int i = 0; i < 100; ++i) distances.push_back(i), quality.push_back(1);
  EXPECT_EQ(reliable_distance(distances, quality), 99);
  for (int i = 60; i < 100; ++i) quality[i] = 0.1;
  EXPECT_EQ(reliable_distance(distances, quality), 62) << "3 of 63 are below, 4 of 64 are too many";
  quality[80] = distances[81] = NAN;  // not mapped
  EXPECT_EQ(reliable_distance(distances, quality), 62);
  std::ranges::fill(std::span(quality).first(2), 0.1);
  EXPECT_EQ(reliable_distance(distances, quality), 60) << "3 of 61";
  std::ranges::fill(quality, 0.1);
  EXPECT_EQ(reliable_distance(distances, quality), std::nullopt);
  EXPECT_EQ(reliable_distance(std::vector{0.0}, std::vector{1.0}), 0) << "fewer than 20 entries: all count";
  EXPECT_THROW(reliable_distance(distances, std::vector{1.0}), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
