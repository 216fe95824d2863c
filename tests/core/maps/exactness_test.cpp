// Laws of every map. In flat space it is the identity whatever the weights, masses and frames (Remark 2, App. B); it is NaN exactly where
// its status is not ok; it changes with the graph as the definition requires. The graph contract (graph/contract_test.cpp) has more of them.
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/quality.hpp"
#include "core/solved_graph.hpp"

namespace ahm::test {
namespace {

/// Checks coordinates, distances and spread, by both strategies.
void expect_exact_from_everywhere(const FlatGraph& flat, double t_coef = 1) {
  for (Strategy strategy : strategies) {
    const SolvedGraph solved(flat.data, {.t_coef = t_coef, .strategy = strategy});
    ASSERT_FALSE(solved.graph.is_delaunay());  // distances are those of heat
    for (Variant variant : all_variants)
      for (Index p : {Index{0}, flat.size() / 2, flat.size() / 3, flat.size() - 1}) {
        const LogMap map = solved.map(p, {.variant = variant});
        ASSERT_EQ(map.count(Status::ok), flat.size());
        expect_exact(flat, map, p);
        for (Index i = 0; i < flat.size(); ++i) {
          ASSERT_NEAR(map.distance(Vertex(i)), length(flat.exact(p, i)), 1e-11 * flat.diameter());
          ASSERT_LT(map.spread()[i], 1e-5 * flat.diameter());  // the root of a difference has half of the digits
        }
      }
  }
}

/// Every edge split into two parallel ones of a third and two thirds of its weight.
FlatGraph with_parallel_edges(FlatGraph flat) {
  const CsrGraphData g = flat.data;
  CsrGraphData& split = flat.data;
  split.neighbors.clear(), split.weights.clear(), split.logs.clear(), split.transports.clear();
  for (Offset& begin : split.row_begin) begin *= 2;
  for (std::size_t e = 0; e < g.neighbors.size(); ++e)
    for (double share : {1.0 / 3, 2.0 / 3}) {
      split.neighbors.push_back(g.neighbors[e]);
      split.weights.push_back(share * g.weights[e]);
      split.logs.insert(split.logs.end(), {g.logs[2 * e], g.logs[2 * e + 1]});
      split.transports.insert(split.transports.end(), {g.transports[2 * e], g.transports[2 * e + 1]});
    }
  return flat;
}

TEST(LogMap, IsExactOnFlatGraphs) {
  for (double t_coef : {0.1, 1.0, 100.0}) expect_exact_from_everywhere(planar_triangulation(24), t_coef);
  for (const FlatGraph& flat :
       {mirrored_plane(16), line_graph(50), lattice3(7), with_parallel_edges(planar_triangulation(8))})
    expect_exact_from_everywhere(flat);
}

TEST(LogMap, IsExactFromStraightCurves) {
  for (const FlatGraph& flat : {planar_triangulation(12), mirrored_plane(12)}) {
    const SolvedGraph plane(flat.data);
    const auto position = [&](Index i) { return std::span(flat.positions).subspan(2 * to_size(i), 2); };
    Source row(2);
    for (Index k = 60; k < 72; ++k)
      row.add(Vertex(k), 1.0 + 0.1 * k, position(k), std::span(flat.frames).subspan(4 * to_size(k), 4));
    for (Variant variant : all_variants) {
      const LogMap map = plane.map(row, {.variant = variant});
      for (Index i = 0; i < flat.size(); ++i)
        expect_near(map.coordinates(Vertex(i)), position(i), 1e-11 * flat.diameter());
    }
  }
}

TEST(SourceVertices, HaveTheVectorZeroInMaps) {
  for (const Strategy strategy : strategies) {
    const SolvedGraph sphere(sphere_graph(700), {.strategy = strategy});
    for (const Variant variant : all_variants) {
      const LogMap map = sphere.map(20, {.variant = variant});
      for (const double x : map.coordinates(Vertex{20})) EXPECT_EQ(x, 0);
      EXPECT_EQ(map.distance(Vertex{20}), 0);
      EXPECT_EQ(map.spread()[20], 0);
      EXPECT_EQ(map_quality(sphere.graph, map)[20], 1);
    }
  }
}

void expect_nan_exactly_where_not_ok(const LogMap& map) {
  for (Index i = 0; i < map.size(); ++i)
    for (double x : map.coordinates(Vertex(i)))
      ASSERT_EQ(std::isnan(x), map.status(Vertex(i)) != Status::ok) << "vertex " << i;
}

TEST(Reach, IsSevenHundredEdgesAndGrowsWithTheDiffusionTime) {
  const FlatGraph flat = strip(3000);
  const SolvedGraph solved(flat.data, {.strategy = Strategy::global});
  for (Variant variant : all_variants) {
    const LogMap map = solved.map(1, {.variant = variant});
    expect_nan_exactly_where_not_ok(map);
    expect_exact(flat, map, 1);
    EXPECT_EQ(map.count(Status::ok) + map.count(Status::unreached), flat.size());
    Index farthest = flat.size() - 1;
    while (map.status(Vertex(farthest)) != Status::ok) --farthest;
    // Heat falls by the factor (3 - sqrt 5)/2 = 2^-1.39 per edge of this strip: 970 powers of two reach 698 edges.
    EXPECT_GT(farthest / 3, 680);
    EXPECT_LT(farthest / 3, 710);
  }
  EXPECT_EQ(SolvedGraph(flat.data, {.t_coef = 64.0}).map(1).count(Status::ok), flat.size());
}

TEST(Reach, IsNeverOverstatedWhereFactorsHaveLongJumps) {
  // In two dimensions the factors join distant vertices directly, and such entries underflow before the solution does.
  const FlatGraph flat = planar_triangulation(120);
  for (double t_coef : {1e-1, 1e-2, 1e-4})
    for (Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
      SCOPED_TRACE(t_coef);
      const SolvedGraph solved(flat.data, {.t_coef = t_coef, .strategy = Strategy::global, .ordering = ordering});
      for (Variant variant : all_variants) expect_exact(flat, solved.map(0, {.variant = variant}), 0);
    }
}

TEST(Reach, OfTransportedVectorsEndsWithTheirHeat) {
  const SolvedGraph solved(strip(3000).data);
  const auto field = transport_vectors(solved.solver, std::array{Vertex{0}}, std::array{1.0, 0.0});
  for (std::size_t i = 0; i < field.status.size(); ++i)
    if (field.status[i] == Status::ok)
      ASSERT_NEAR(std::hypot(field.values[2 * i], field.values[2 * i + 1]), 1.0, 1e-11) << "vertex " << i;
  EXPECT_EQ(field.status.back(), Status::unreached);
}

TEST(Reach, EndsAtEdgesWithoutWeight) {
  CsrGraphData g = line_graph(6).data;
  for (Index i : {2, 3})
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e)
      if (g.neighbors[e] == 5 - i) g.weights[e] = 0.0;
  const LogMap map = SolvedGraph(g).map(0);
  EXPECT_EQ(map.status(Vertex{2}), Status::ok);
  EXPECT_EQ(map.status(Vertex{3}), Status::disconnected);
  CsrGraphData single;
  single.row_begin = {0, 0};
  single.masses = {2.0};
  const LogMap alone = SolvedGraph(single).map(0);
  EXPECT_EQ(alone.status(Vertex{0}), Status::ok);
  EXPECT_EQ(alone.distance(Vertex{0}), 0.0);
}

TEST(Reach, EndsAtTheRadiusAndChangesNothingWithinIt) {
  const SolvedGraph plane(planar_triangulation(16).data);
  const LogMap whole = plane.map(100), local = plane.map(100, {.radius = 0.3});
  expect_nan_exactly_where_not_ok(local);
  for (Index i = 0; i < whole.size(); ++i) {
    ASSERT_EQ(local.status(Vertex(i)), whole.distance(Vertex(i)) <= 0.3 ? Status::ok : Status::beyond_radius);
    if (local.status(Vertex(i)) == Status::ok)
      ASSERT_TRUE(same_bits(local.coordinates(Vertex(i)), whole.coordinates(Vertex(i))));
  }
  EXPECT_GT(local.count(Status::beyond_radius), 0);
  EXPECT_GT(local.count(Status::ok), 0);
}

#ifdef __SSE2__
TEST(Reach, DoesNotNeedDenormalNumbers) {
  const CsrGraphData data = strip(3000).data;
  const LogMap expected = SolvedGraph(data).map(1);
  // A caller compiled with -ffast-math switches them off for the whole process.
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode | 0x8040);  // flush to zero, denormals are zero
  const LogMap map = SolvedGraph(data).map(1);
  _mm_setcsr(mode);
  EXPECT_LT(difference(map, expected), 1e-11);
}
#endif

TEST(Reach, IsTheWholeGraphForMassesOfTwentyOrdersOfMagnitude) {
  FlatGraph flat = planar_triangulation(12);
  for (std::size_t i = 0; i < flat.data.masses.size(); ++i)
    flat.data.masses[i] *= std::pow(10.0, -20.0 * (i % 5) / 4.0);
  const SolvedGraph plane(flat.data);
  for (Index p : {3, 4, 70}) {
    const LogMap map = plane.map(p);
    EXPECT_EQ(map.count(Status::ok), flat.size());
    expect_exact(flat, map, p);
  }
}

class Symmetry : public testing::TestWithParam<Variant> {
 protected:
  static std::vector<double> solve(const CsrGraphData& data, HeatOptions options = {}) {
    options.variant = GetParam();
    const LogMap map = SolvedGraph(data, options).map(5);
    return {map.coordinates().begin(), map.coordinates().end()};
  }
  /// Expects the coordinates of the sphere after `change`.
  template <class Change>
  void expect_changed(const std::vector<double>& found, const Change& change) const {
    std::vector<double> changed = expected;
    for (std::size_t i = 0; i < changed.size(); i += 2) {
      const Vec2 z = change(Vec2{expected[i], expected[i + 1]});
      changed[i] = z[0], changed[i + 1] = z[1];
    }
    expect_near(found, changed, 1e-11);
  }
  const CsrGraphData sphere = sphere_graph(400);
  const std::vector<double> expected = solve(sphere);
};

TEST_P(Symmetry, ScalesByPowersOfTwoToTheBitAndRepeats) {
  CsrGraphData in_units = sphere;
  in_units.length_unit = 1024.0;
  const auto scaled_map = [&](int exponent) { return solve(scaled(sphere, std::ldexp(1.0, exponent))); };
  for (const auto& [map, exponent] :
       {std::pair{solve(sphere), 0}, {solve(in_units), 10}, {scaled_map(-300), -300}, {scaled_map(300), 300}})
    for (std::size_t k = 0; k < map.size(); ++k) ASSERT_EQ(map[k], std::ldexp(expected[k], exponent));
}

TEST_P(Symmetry, TurnsWithTheSourceFrameAndConjugatesWithTheOrientation) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const LogMap map = SolvedGraph(sphere, {.variant = GetParam()}).map(Source::at_vertex(Vertex{5}, Vec2{3 * c, 3 * s}));
  expect_changed({map.coordinates().begin(), map.coordinates().end()}, [&](const Vec2& z) {
    return Vec2{c * z[0] + s * z[1], c * z[1] - s * z[0]};
  });
  expect_changed(solve(mirrored(sphere)), [](const Vec2& z) { return Vec2{z[0], -z[1]}; });
}

TEST_P(Symmetry, IsTheSameOnBlocksAndForEveryOrdering) {
  expect_near(solve(as_blocks(sphere)), expected, 1e-11);
  expect_near(solve(sphere, {.ordering = Ordering::nested_dissection}), expected, 1e-11);
  expect_near(solve(as_blocks(sphere), {.ordering = Ordering::nested_dissection}), expected, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Variants, Symmetry, testing::ValuesIn(all_variants),
                         [](const auto& info) { return std::string(to_string(info.param)); });

}  // namespace
}  // namespace ahm::test
