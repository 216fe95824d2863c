// The second moment of heat: distances that are accurate at cut loci, and the spread of a map.
#include "ahm/conformance/closed_forms.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "core/solved_graph.hpp"
#include "maps/affine_heat.hpp"

namespace ahm::test {
namespace {

// q / lambda >= |phi|^2 by Jensen's inequality.
TEST(SecondMoment, HasAVarianceThatIsNotNegative) {
  for (const CsrGraphData& data : {sphere_graph(2500), as_blocks(sphere_graph(900)), bent_lattice(10), tube(60, 9)}) {
    const CsrGraph graph(data);
    const HeatOperators operators(graph);
    for (Variant variant : all_variants) {
      AffineHeat heat(graph, operators, variant, {right_hand_side_of(source_at(7), graph, operators, variant)});
      heat.diffuse();
      heat.solve();
      heat.solve_squares();
      std::vector<double> phi(to_size(graph.dimension()));
      for (Index i = 0; i < graph.size(); ++i) {
        heat.coordinates_at(0, i, phi.data());
        if (i != 7) ASSERT_GE(heat.root_mean_square_at(0, i), length(phi) * (1 - 1e-12));
      }
    }
  }
}

/// 95th percentile of the relative error of the distance on the unit sphere from one vertex.
double error_on_sphere(Index parts, Variant variant) {
  const Mesh mesh = icosphere(parts);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  CsrGraphData data = stored(surface.graph());
  data.is_delaunay = false;
  const SolvedGraph sphere(data);
  const LogMap map = sphere.map(40, {.variant = variant});
  const double h = sphere.graph.mean_edge_length();
  std::vector<double> errors;
  for (Index i = 0; i < map.size(); ++i) {
    const double exact = sphere_distance(mesh.positions[40], mesh.positions[i]);
    if (exact > 5 * h) errors.push_back(std::abs(map.distance(Vertex(i)) - exact) / exact);
  }
  std::ranges::sort(errors);
  EXPECT_LT(errors.back(), 4 * h * sphere.graph.length_unit());  // at the antipode too, where |phi| is 0
  return errors[errors.size() * 95 / 100];
}

TEST(SecondMoment, IsAccurateOnTheWholeSphereAndConverges) {
  for (Variant variant : all_variants) {
    const double coarse = error_on_sphere(10, variant), fine = error_on_sphere(32, variant);
    EXPECT_LT(coarse, 0.12);
    EXPECT_LT(fine, 0.5 * coarse);
  }
}

TEST(SecondMoment, SpreadsAcrossACutLocusOnly) {
  const LogMap map = SolvedGraph(tube(61, 60)).map(30 * 60);
  const Index opposite = 30 * 60 + 30, quarter = 30 * 60 + 15;
  EXPECT_GT(map.spread()[opposite], 0.9 * 30);  // two geodesic paths of length 30 in opposite directions
  EXPECT_LT(map.spread()[quarter], 1e-3 * 15);
  EXPECT_NEAR(map.distance(Vertex(opposite)), 30, 0.2);
  EXPECT_LT(length(map.coordinates(Vertex(opposite))), 1);
}

/// A tube longer than the reach of a global solve, so that its map is completed by a march.
CsrGraphData long_delaunay_tube() {
  CsrGraphData data = tube(900, 5);
  data.is_delaunay = true;
  return data;
}

TEST(SecondMoment, MayBeOmittedWithoutOtherChanges) {
  for (const CsrGraphData& data : {long_delaunay_tube(), tube(60, 9)}) {
    const SolvedGraph solved(data);
    for (Variant variant : all_variants) {
      const LogMap all = solved.map(7, {.variant = variant});
      const LogMap map = solved.map(7, {.variant = variant, .spread = false});
      ASSERT_EQ(map.strategy(), data.is_delaunay ? Strategy::march : Strategy::global);
      ASSERT_EQ(map.strategy(), all.strategy());
      ASSERT_TRUE(std::ranges::equal(map.distances(), all.distances()));
      ASSERT_TRUE(std::ranges::equal(map.coordinates(), all.coordinates()));
      EXPECT_FALSE(all.spread().empty());
      EXPECT_TRUE(map.spread().empty());
      EXPECT_THROW(map_quality(solved.graph, map), InvalidArgument);
    }
  }
}

TEST(Distances, MayBeOmittedWithoutOtherChanges) {
  for (const CsrGraphData& data : {long_delaunay_tube(), sphere_graph(900), bent_lattice(10)})
    for (const Strategy strategy : {Strategy::automatic, Strategy::march}) {
      const SolvedGraph solved(data, {.strategy = strategy});
      const LogMap all = solved.map(7, {.frames = true}), map = solved.map(7, {.frames = true, .distances = false});
      ASSERT_EQ(map.strategy(), all.strategy());
      ASSERT_TRUE(std::ranges::equal(map.coordinates(), all.coordinates()));
      ASSERT_TRUE(std::ranges::equal(map.status(), all.status()));
      ASSERT_TRUE(std::ranges::equal(map.frames(), all.frames()));
      for (Index i = 0; i < map.size(); ++i) ASSERT_EQ(map.distance(Vertex(i)), length(map.coordinates(Vertex(i))));
      EXPECT_TRUE(map.spread().empty() && map.directions().empty());
      EXPECT_THROW(map_quality(solved.graph, map), InvalidArgument);
    }
  const LogMap near = SolvedGraph(sphere_graph(900)).map(7, {.radius = 1, .distances = false});
  EXPECT_GT(near.count(Status::beyond_radius), 300);
  for (Index i = 0; i < near.size(); ++i)
    ASSERT_TRUE(near.status(Vertex(i)) == Status::ok ? near.distance(Vertex(i)) <= 1
                                                     : std::isnan(near.coordinates(Vertex(i))[0]));
}

TEST(Components, HaveAMapOfTheirOwnNextToAnotherScale) {
  const CsrGraphData one = sphere_graph(1500), two = joined(one, scaled(sphere_graph(900), 32));
  for (Strategy strategy : strategies)
    for (Variant variant : all_variants) {
      const SolvedGraph alone(one, {.variant = variant, .strategy = strategy});
      const SolvedGraph with_a_large_one(two, {.variant = variant, .strategy = strategy});
      const LogMap a = alone.map(11), b = with_a_large_one.map(11);
      const auto quality_a = map_quality(alone.graph, a), quality_b = map_quality(with_a_large_one.graph, b);
      expect_near(b.distances().first(1500), a.distances(), 1e-9);
      expect_near(b.coordinates().first(3000), a.coordinates(), 1e-9);
      expect_near(std::span(quality_b).first(1500), quality_a, 1e-6);  // a difference of squares, as the spread
      EXPECT_EQ(b.count(Status::disconnected), 900);
    }
}

}  // namespace
}  // namespace ahm::test
