// The second moment of heat: distances that hold at cut loci, and the spread of a map.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/affine_heat.hpp"

namespace ahm::test {
namespace {

const std::array strategies{Strategy::global, Strategy::march};

// Any triangulation, any weights, both arithmetic paths, one to three dimensions.
TEST(SecondMoment, IsTheDistanceOnFlatGraphs) {
  for (const FlatGraph& flat :
       {planar_triangulation(30), planar_triangulation(20, TransportKind::block, true), line_graph(200), lattice3(9)}) {
    const CsrGraph graph(flat.data);
    ASSERT_FALSE(graph.is_delaunay());
    for (Strategy strategy : strategies)
      for (Variant variant : all_variants) {
        const LogMapSolver solver(graph, {.variant = variant, .strategy = strategy});
        const LogMap map = solver.solve(Source::at_vertex(Vertex{33}));
        for (Index i = 0; i < graph.size(); ++i) {
          ASSERT_NEAR(map.distance(Vertex(i)), length(flat.exact(33, i)), 1e-11 * flat.diameter());
          // A root of a difference keeps half the digits.
          ASSERT_LT(map.spread()[i], 1e-5 * flat.diameter());
        }
      }
  }
}

// q / lambda >= |phi|^2 by Jensen's inequality.
TEST(SecondMoment, HasAVarianceThatIsNotNegative) {
  for (const CsrGraphData& data : {sphere_graph(2500), as_blocks(sphere_graph(900)), bent_lattice(10), tube(60, 9)}) {
    const CsrGraph graph(data);
    const HeatOperators operators(graph);
    for (Variant variant : all_variants) {
      AffineHeat heat(graph, operators, variant,
                      {right_hand_side_of(Source::at_vertex(Vertex{7}), graph, operators, variant)});
      heat.diffuse();
      heat.solve();
      heat.solve_squares();
      std::vector<double> phi(static_cast<std::size_t>(graph.dimension()));
      for (Index i = 0; i < graph.size(); ++i) {
        heat.coordinates_at(0, i, phi.data());
        if (i != 7) ASSERT_GE(heat.root_mean_square_at(0, i), length(phi) * (1 - 1e-12));
      }
    }
  }
}

/// Errors of the distance on the unit sphere from one vertex: 95th percentile, relative.
double error_on_sphere(Index parts, Variant variant) {
  const Mesh mesh = icosphere(parts);
  const std::vector<Vec3>& points = mesh.positions;
  const auto surface = trimesh::TriangleMeshSurface::build(points, mesh.faces);
  CsrGraphData data = stored(surface.graph());
  data.is_delaunay = false;
  const CsrGraph graph(data);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{40}), {.variant = variant});
  std::vector<double> errors;
  for (Index i = 0; i < graph.size(); ++i) {
    const double exact = sphere_distance(points[40], points[i]);
    if (exact > 5 * graph.mean_edge_length()) errors.push_back(std::abs(map.distance(Vertex(i)) - exact) / exact);
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors.back(),
            4 * graph.mean_edge_length() * graph.length_unit());  // at the antipode too, where |phi| is 0
  return errors[errors.size() * 95 / 100];
}

TEST(SecondMoment, HoldsOnTheWholeSphereAndConverges) {
  for (Variant variant : all_variants) {
    const double coarse = error_on_sphere(10, variant), fine = error_on_sphere(32, variant);
    EXPECT_LT(coarse, 0.12);
    EXPECT_LT(fine, 0.5 * coarse);
  }
}

TEST(SecondMoment, IsTheSameByMarch) {
  for (const CsrGraphData& data : {sphere_graph(6000), as_blocks(sphere_graph(3000)), bent_lattice(12)}) {
    const CsrGraph graph(data);
    for (Variant variant : all_variants) {
      const LogMap expected =
          LogMapSolver(graph, {.variant = variant, .strategy = Strategy::global}).solve(Source::at_vertex(Vertex{5}));
      const LogMap map =
          LogMapSolver(graph, {.variant = variant, .strategy = Strategy::march}).solve(Source::at_vertex(Vertex{5}));
      for (Index i = 0; i < graph.size(); ++i)
        ASSERT_NEAR(map.distance(Vertex(i)), expected.distance(Vertex(i)), 1e-7) << "vertex " << i;
    }
  }
}

TEST(SecondMoment, SpreadsAcrossACutLocusOnly) {
  const Index around = 60, rings = 61;
  const CsrGraph graph(tube(rings, around));
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex(30 * around)));
  const auto at = [&](Index k) { return 30 * around + k; };
  EXPECT_GT(map.spread()[at(30)], 0.9 * 30);  // both ways round, 30 each
  EXPECT_LT(map.spread()[at(15)], 1e-3 * 15);
  EXPECT_NEAR(map.distance(Vertex(at(30))), 30, 0.2);
  EXPECT_LT(length(map.coordinates(Vertex(at(30)))), 1);
}

// What is left out changes nothing else, not where a map marches on beyond the reach of a global solve either.
TEST(SecondMoment, MayBeLeftOut) {
  CsrGraphData delaunay = tube(900, 5);
  delaunay.is_delaunay = true;
  for (const CsrGraphData& data : {delaunay, tube(60, 9)}) {
    const CsrGraph graph(data);
    const LogMapSolver solver(graph);
    for (Variant variant : all_variants) {
      const LogMap all = solver.solve(Source::at_vertex(Vertex{7}), {.variant = variant});
      const LogMap map = solver.solve(Source::at_vertex(Vertex{7}), {.variant = variant, .spread = false});
      ASSERT_EQ(map.strategy(), all.strategy());
      for (std::size_t i = 0; i < map.distances().size(); ++i) {
        ASSERT_EQ(map.distances()[i], all.distances()[i]);
        ASSERT_EQ(map.coordinates()[2 * i], all.coordinates()[2 * i]);
      }
      EXPECT_FALSE(all.spread().empty());
      EXPECT_TRUE(map.spread().empty());
      EXPECT_THROW(map_quality(graph, map), InvalidArgument);
    }
  }
  const CsrGraph long_tube(delaunay);
  EXPECT_EQ(LogMapSolver(long_tube).solve(Source::at_vertex(Vertex{7})).strategy(), Strategy::march);
}

TEST(Distances, MayBeLeftOut) {
  CsrGraphData delaunay = tube(900, 5);
  delaunay.is_delaunay = true;
  for (const CsrGraphData& data : {delaunay, sphere_graph(900), bent_lattice(10)}) {
    const CsrGraph graph(data);
    for (const Strategy strategy : {Strategy::automatic, Strategy::march}) {
      const LogMapSolver solver(graph, {.strategy = strategy});
      const Source source = Source::at_vertex(Vertex{7});
      const LogMap all = solver.solve(source, {.frames = true});
      const LogMap map = solver.solve(source, {.frames = true, .distances = false});
      ASSERT_EQ(map.strategy(), all.strategy());
      ASSERT_TRUE(std::ranges::equal(map.coordinates(), all.coordinates()));
      ASSERT_TRUE(std::ranges::equal(map.status(), all.status()));
      ASSERT_TRUE(std::ranges::equal(map.frames(), all.frames()));
      for (Index i = 0; i < graph.size(); ++i) ASSERT_EQ(map.distance(Vertex(i)), length(map.coordinates(Vertex(i))));
      EXPECT_TRUE(map.spread().empty() && map.directions().empty());
      EXPECT_THROW(map_quality(graph, map), InvalidArgument);
    }
  }
  const CsrGraph graph(sphere_graph(900));
  const LogMap near = LogMapSolver(graph).solve(Source::at_vertex(Vertex{7}), {.radius = 1, .distances = false});
  EXPECT_GT(near.count(Status::beyond_radius), 300);
  for (Index i = 0; i < graph.size(); ++i)
    ASSERT_TRUE(near.status(Vertex(i)) == Status::ok ? near.distance(Vertex(i)) <= 1
                                                     : std::isnan(near.coordinates(Vertex(i))[0]));
}

TEST(Distances, AreZeroAtTheSource) {
  const CsrGraph graph(sphere_graph(500));
  for (Variant variant : all_variants)
    EXPECT_EQ(LogMapSolver(graph, {.variant = variant}).solve(Source::at_vertex(Vertex{9})).distance(Vertex{9}), 0);
}

// A component's numbers do not depend on what else is in the graph, whatever its scale.
TEST(Components, HaveAMapOfTheirOwn) {
  const CsrGraphData one = sphere_graph(1500);
  const CsrGraph alone(one), with_a_large_one(joined(one, scaled(sphere_graph(900), 32)));
  for (Strategy strategy : strategies)
    for (Variant variant : all_variants) {
      const HeatOptions options{.variant = variant, .strategy = strategy};
      const LogMap a = LogMapSolver(alone, options).solve(Source::at_vertex(Vertex{11})),
                   b = LogMapSolver(with_a_large_one, options).solve(Source::at_vertex(Vertex{11}));
      const auto quality_a = map_quality(alone, a), quality_b = map_quality(with_a_large_one, b);
      for (Index i = 0; i < alone.size(); ++i) {
        ASSERT_NEAR(a.distance(Vertex(i)), b.distance(Vertex(i)), 1e-9);
        for (int c = 0; c < 2; ++c) ASSERT_NEAR(a.coordinates(Vertex(i))[c], b.coordinates(Vertex(i))[c], 1e-9);
        ASSERT_NEAR(quality_a[i], quality_b[i], 1e-6);  // as the spread, a difference of squares
      }
      EXPECT_EQ(b.count(Status::disconnected), 900);
    }
}

TEST(LocalMaps, HaveTheDistancesOfWholeMaps) {
  const CsrGraph graph(sphere_graph(4000));
  const double radius = 6 * graph.mean_edge_length();
  const LocalMaps maps = local_maps(graph, std::array{Vertex{40}}, {.radius = radius, .margin = 6});
  const LogMap whole = LogMapSolver(graph).solve(Source::at_vertex(Vertex{40}));
  ASSERT_EQ(maps.neighbors.front(), Vertex(40));
  ASSERT_EQ(maps.distances.front(), 0);
  for (std::size_t e = 0; e < maps.neighbors.size(); ++e)
    EXPECT_NEAR(maps.distances[e], whole.distance(maps.neighbors[e]), 1e-4 * radius);
}

}  // namespace
}  // namespace ahm::test
