// The frames of a map, and the quality judged by them.
#include "ahm/maps/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

const HeatOptions by_factors{.strategy = Strategy::global}, by_march{.strategy = Strategy::march};

TEST(MapFrames, AreTheParallelTransportOfTheSourcesAxes) {
  const CsrGraph graph(sphere_graph(3000));
  const LogMapSolver solver(graph, by_factors);
  const LogMap map = solver.solve(Source::at_vertex(Vertex{5}), {.frames = true});
  const VertexField carried = parallel_transport(solver, Source::at_vertex(Vertex{5}));
  ASSERT_EQ(map.frames().size(), carried.values.size());
  for (std::size_t k = 0; k < carried.values.size(); ++k) ASSERT_NEAR(map.frames()[k], carried.values[k], 1e-12);
}

TEST(MapFrames, AreTheSameByMarch) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(3000)), bent_lattice(12)}) {
    const CsrGraph graph(data);
    const LogMap expected = LogMapSolver(graph, by_factors).solve(Source::at_vertex(Vertex{5}), {.frames = true});
    const LogMap map = LogMapSolver(graph, by_march).solve(Source::at_vertex(Vertex{5}), {.frames = true});
    ASSERT_EQ(map.frames().size(), expected.frames().size());
    double largest = 0;
    for (std::size_t k = 0; k < map.frames().size(); ++k)
      largest = std::max(largest, std::abs(map.frames()[k] - expected.frames()[k]));
    EXPECT_LT(largest, 1e-6);
  }
}

TEST(MapFrames, AreKeptOnlyWhereAskedFor) {
  const CsrGraph graph(sphere_graph(100));
  EXPECT_TRUE(LogMapSolver(graph).solve(Source::at_vertex(Vertex{0})).frames().empty());
}

TEST(MapQuality, IsOneOnFlatGeometry) {
  for (const FlatGraph& flat :
       {planar_triangulation(40), lattice3(9), planar_triangulation(20, TransportKind::block, true)}) {
    const CsrGraph graph(flat.data);
    const Source source = Source::at_vertex(Vertex(graph.size() / 2 + 3));
    const LogMap map = LogMapSolver(graph).solve(source, {.frames = true});
    const std::vector<double> quality = map_quality(graph, map);
    Wavefront front(graph);
    front.add(source);
    front.run();
    int straight = 0;  // others bend around notches of the boundary
    for (Index i = 0; i < graph.size(); ++i) {
      if (front.distance(Vertex(i)) > (1 + 1e-9) * map.distance(Vertex(i))) continue;
      ++straight;
      ASSERT_NEAR(quality[i], 1.0, 1e-6) << i;
    }
    EXPECT_GT(straight, 0.9 * graph.size());
  }
}

// On a tube the cut locus is the line opposite to the source: the map jumps from one side to the other.
TEST(MapQuality, FindsTheCutLocus) {
  const Index around = 60, rings = 121;
  const CsrGraph graph(tube(rings, around));
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex(60 * around)), {.frames = true});
  const std::vector<double> quality = map_quality(graph, map);
  for (Index r = 0; r < rings; ++r) {
    // Around the tube the two ways to the line meet at an angle that closes with the distance along the tube.
    if (std::abs(r - 60) <= 15) {
      EXPECT_LT(quality[r * around + around / 2], trusted_quality) << "ring " << r;
    }
    EXPECT_GT(quality[r * around + around / 4], 0.99) << "ring " << r;
    EXPECT_GT(quality[r * around], 0.99) << "ring " << r;
  }
}

TEST(MapQuality, IsTheSameBesideAFrontMadeWithoutTheMap) {
  CsrGraphData data = tube(61, 60);
  data.is_delaunay = false;
  const CsrGraph graph(data);
  const Source source = Source::at_vertex(Vertex(30 * 60));
  for (const double radius : {std::numeric_limits<double>::infinity(), 10 * graph.mean_edge_length()}) {
    const LogMap map = LogMapSolver(graph).solve(source, {.radius = radius});
    const ReferenceFront front(graph, source, radius);
    ASSERT_NE(front.get(), nullptr);
    const std::vector<double> expected = map_quality(graph, map), quality = map_quality(graph, map, front, 2);
    for (Index i = 0; i < graph.size(); ++i)
      ASSERT_TRUE(quality[i] == expected[i] || (std::isnan(quality[i]) && std::isnan(expected[i]))) << "vertex " << i;
  }
  data.is_delaunay = true;
  EXPECT_EQ(ReferenceFront(CsrGraph(data), source).get(), nullptr);
}

TEST(MapQuality, IsNanWhereTheMapIs) {
  const FlatGraph flat = planar_triangulation(20);
  const CsrGraph graph(doubled(flat.data));
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}), {.radius = 0.5, .frames = true});
  const std::vector<double> quality = map_quality(graph, map);
  for (Index i = 0; i < graph.size(); ++i) ASSERT_EQ(std::isnan(quality[i]), map.status(Vertex(i)) != Status::ok);
  EXPECT_GT(map.count(Status::beyond_radius), 0);
  EXPECT_EQ(map.count(Status::disconnected), flat.size());
}

TEST(MapQuality, NeedsTheRightGraphAndOfCurvesThePlane) {
  const CsrGraph graph(sphere_graph(200)), other(sphere_graph(300));
  const LogMapSolver solver(graph);
  EXPECT_THROW(map_quality(other, solver.solve(Source::at_vertex(Vertex{0}))), InvalidArgument);
  const CsrGraph space(lattice3(6).data);
  const Source curve = Source(3).add(Vertex{3}, 1, std::array{0.0, 0.0, 0.0}, {}, {0, 0.0});
  EXPECT_THROW(map_quality(space, LogMapSolver(space).solve(curve)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
