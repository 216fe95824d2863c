// The frames of a map, and the quality judged by them.
#include "ahm/maps/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/testing/curved_graphs.hpp"
#include "ahm/testing/flat_graphs.hpp"
#include "ahm/testing/graph_changes.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

const HeatOptions global{.strategy = Strategy::global}, marching{.strategy = Strategy::march};

TEST(MapFrames, AreTheParallelTransportOfTheSourcesAxes) {
  const CsrGraph graph(sphere_graph(3000));
  const LogMapSolver solver(graph, global);
  const LogMap map = solver.solve(Source::at_vertex(Vertex{5}), {.frames = true});
  const VertexField carried = parallel_transport(solver, Source::at_vertex(Vertex{5}));
  ASSERT_EQ(map.frames().size(), carried.values.size());
  for (std::size_t k = 0; k < carried.values.size(); ++k) ASSERT_NEAR(map.frames()[k], carried.values[k], 1e-12);
}

TEST(MapFrames, AreTheSameByMarch) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(3000)), bent_lattice(12)}) {
    const CsrGraph graph(data);
    const LogMap expected = LogMapSolver(graph, global).solve(Source::at_vertex(Vertex{5}), {.frames = true});
    const LogMap map = LogMapSolver(graph, marching).solve(Source::at_vertex(Vertex{5}), {.frames = true});
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
    const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{33}), {.frames = true});
    for (double q : map_quality(graph, map)) ASSERT_NEAR(q, 1.0, 1e-12);
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

/// An open tube of radius 1 whose edges around and along it are equally long.
/// @param turned  by half an edge: every second ring
Mesh open_tube(Index around, Index rings, bool turned) {
  Mesh mesh;
  for (Index k = 0; k < rings; ++k)
    for (Index i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * (i + (turned ? 0.5 * (k % 2) : 0)) / around;
      mesh.positions.push_back({std::cos(angle), std::sin(angle), 2 * std::numbers::pi / around * k});
    }
  for (Index k = 0; k + 1 < rings; ++k)
    for (Index i = 0; i < around; ++i) {
      const Index a = k * around + i, b = k * around + (i + 1) % around;
      if (turned && k % 2 == 0) {
        mesh.faces.push_back({a, b, a + around});
        mesh.faces.push_back({b, b + around, a + around});
      } else {
        mesh.faces.push_back({a, b, b + around});
        mesh.faces.push_back({a, b + around, a + around});
      }
    }
  return mesh;
}

// Beside its distance a vector is hardly off where all that lies around a tube has come to lie on a line. Where it does depends on
// how edges lie, and on whether distances are unfolded.
TEST(MapQuality, SeesThatATubeIsMappedToALine) {
  const Index around = 24, rings = 160;
  struct Case {
    double scale;
    bool turned, flips;
  };
  for (const auto& [scale, turned, flips] :
       {Case{1, false, true}, Case{1, true, true}, Case{1, false, false}, Case{1, true, false},
        Case{0x1p-990, false, true}, Case{0x1p900, false, true}}) {
    const Mesh mesh = open_tube(around, rings, turned);
    std::vector<Vec3> positions;
    for (const Vec3& p : mesh.positions) positions.push_back({scale * p[0], scale * p[1], scale * p[2]});
    const auto surface = trimesh::TriangleMeshSurface::build(positions, mesh.faces, {.intrinsic_delaunay = flips});
    const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row(5)).source);
    const std::vector<double> quality = map_quality(surface.graph(), map);
    int near = 0, trusted_near = 0, far = 0, trusted_far = 0;
    for (Index v = 0; v < around * rings; ++v) {
      const double along = 2 * std::numbers::pi / around * (v / around);
      const bool trusted = quality[surface.vertex(Row(v)).index] >= trusted_quality;
      if (map.distance(surface.vertex(Row(v))) < 2 * scale) ++near, trusted_near += trusted;
      if (along > 25) ++far, trusted_far += trusted;
    }
    EXPECT_GT(near, 80);
    EXPECT_GT(trusted_near, 0.95 * near) << turned << flips;
    EXPECT_GT(far, 1000);
    EXPECT_LT(trusted_far, 0.2 * far) << turned << flips;
  }
}

TEST(MapQuality, IsTheSameBesideAFrontMadeWithoutTheMap) {
  CsrGraphData data = tube(61, 60);
  data.is_delaunay = false;
  const CsrGraph graph(data);
  const Source source = Source::at_vertex(Vertex(30 * 60));
  for (const double radius : {std::numeric_limits<double>::infinity(), 10 * graph.mean_edge_length()}) {
    const LogMap map = LogMapSolver(graph).solve(source, {.radius = radius});
    const QualityFront front(graph, source, radius);
    ASSERT_NE(front.get(), nullptr);
    const std::vector<double> expected = map_quality(graph, map), quality = map_quality(graph, map, front, 2).quality;
    for (Index i = 0; i < graph.size(); ++i)
      ASSERT_TRUE(quality[i] == expected[i] || (std::isnan(quality[i]) && std::isnan(expected[i]))) << "vertex " << i;
  }
  data.is_delaunay = true;
  EXPECT_EQ(QualityFront(CsrGraph(data), source).get(), nullptr);
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
