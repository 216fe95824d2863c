// Statuses: never a wrong number, NaN exactly where the status is not ok.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

void expect_nan_exactly_where_not_ok(const LogMap& map) {
  for (Index i = 0; i < map.size(); ++i)
    for (double x : map.coordinates(Vertex(i)))
      ASSERT_EQ(std::isnan(x), map.status(Vertex(i)) != Status::ok) << "vertex " << i;
}

TEST(Reach, IsExactAsFarAsHeatCanBeToldFromNothingAndSaysWhereItEnds) {
  const FlatGraph flat = strip(3000);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph, {.strategy = Strategy::global});
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(Source::at_vertex(Vertex{1}), {.variant = variant});
    expect_nan_exactly_where_not_ok(map);
    Index farthest = 0;
    for (Index i = 0; i < flat.size(); ++i) {
      if (map.status(Vertex(i)) != Status::ok) {
        EXPECT_EQ(map.status(Vertex(i)), Status::unreached);
        continue;
      }
      farthest = std::max(farthest, i / 3);
      const auto exact = flat.exact(1, i);
      ASSERT_NEAR(map.coordinates(Vertex(i))[0], exact[0], 1e-11 * flat.diameter());
      ASSERT_NEAR(map.coordinates(Vertex(i))[1], exact[1], 1e-11 * flat.diameter());
    }
    // Heat falls by the factor (3 - sqrt 5)/2 = 2^-1.39 per edge of this strip: 970 powers of two reach 698 edges.
    EXPECT_GT(farthest, 680);
    EXPECT_LT(farthest, 710);
  }
}

TEST(Reach, IsNeverOverstatedWhereFactorsHoldLongJumps) {
  // In two dimensions the factors join far vertices directly, and such entries underflow before the solution does.
  const FlatGraph flat = planar_triangulation(120);
  const CsrGraph graph(flat.data);
  for (double t_coef : {1e-1, 1e-2, 1e-4})
    for (Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
      const LogMapSolver solver(graph, {.t_coef = t_coef, .strategy = Strategy::global, .ordering = ordering});
      for (Variant variant : all_variants) {
        const LogMap map = solver.solve(Source::at_vertex(Vertex{0}), {.variant = variant});
        for (Index i = 0; i < flat.size(); ++i) {
          if (map.status(Vertex(i)) != Status::ok) continue;
          const auto exact = flat.exact(0, i);
          ASSERT_NEAR(map.coordinates(Vertex(i))[0], exact[0], 1e-11 * flat.diameter())
              << "t_coef " << t_coef << ", vertex " << i;
          ASSERT_NEAR(map.coordinates(Vertex(i))[1], exact[1], 1e-11 * flat.diameter());
        }
      }
    }
}

TEST(Reach, OfTransportedVectorsEndsWithTheirHeat) {
  const FlatGraph flat = strip(3000);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const auto field = transport_vectors(solver, std::array{Vertex{0}}, std::array{1.0, 0.0});
  for (std::size_t i = 0; i < field.status.size(); ++i) {
    if (field.status[i] != Status::ok) continue;
    ASSERT_NEAR(std::hypot(field.values[2 * i], field.values[2 * i + 1]), 1.0, 1e-11) << "vertex " << i;
  }
  EXPECT_EQ(field.status.back(), Status::unreached);
}

TEST(Reach, GrowsWithTheDiffusionTime) {
  const FlatGraph flat = strip(3000);
  const CsrGraph graph(flat.data);
  const LogMap map = LogMapSolver(graph, {.t_coef = 64.0}).solve(Source::at_vertex(Vertex{1}));
  EXPECT_EQ(map.count(Status::ok), flat.size());
}

TEST(Reach, TakesEdgesWithoutWeightForNoConnection) {
  FlatGraph flat = line_graph(6);
  CsrGraphData& g = flat.data;
  for (Index i : {2, 3})
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e)
      if (g.neighbors[e] == 5 - i) g.weights[e] = 0.0;
  const CsrGraph graph(g);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}));
  EXPECT_EQ(map.status(Vertex{2}), Status::ok);
  EXPECT_EQ(map.status(Vertex{3}), Status::disconnected);
}

TEST(Reach, MasksBeyondTheRadiusAndChangesNothingWithin) {
  const FlatGraph flat = planar_triangulation(16);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  const LogMap whole = solver.solve(Source::at_vertex(Vertex{100})),
               local = solver.solve(Source::at_vertex(Vertex{100}), {.radius = 0.3});
  expect_nan_exactly_where_not_ok(local);
  for (Index i = 0; i < flat.size(); ++i) {
    ASSERT_EQ(local.status(Vertex(i)), whole.distance(Vertex(i)) <= 0.3 ? Status::ok : Status::beyond_radius);
    if (local.status(Vertex(i)) == Status::ok)
      ASSERT_EQ(local.coordinates(Vertex(i))[0], whole.coordinates(Vertex(i))[0]);
  }
  EXPECT_GT(local.count(Status::beyond_radius), 0);
  EXPECT_GT(local.count(Status::ok), 0);
}

#ifdef __SSE2__
TEST(Reach, DoesNotNeedDenormalNumbers) {
  // A caller compiled with -ffast-math switches them off for the whole process.
  const FlatGraph flat = strip(3000);
  const CsrGraph graph(flat.data);
  const LogMap expected = LogMapSolver(graph).solve(Source::at_vertex(Vertex{1}));
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode | 0x8040);  // flush to zero, denormals are zero
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{1}));
  _mm_setcsr(mode);
  for (Index i = 0; i < flat.size(); ++i) {
    ASSERT_EQ(map.status(Vertex(i)), expected.status(Vertex(i)));
    if (map.status(Vertex(i)) == Status::ok)
      ASSERT_NEAR(map.coordinates(Vertex(i))[0], expected.coordinates(Vertex(i))[0], 1e-11 * flat.diameter());
  }
}
#endif

TEST(Reach, SolvesASingleVertex) {
  CsrGraphData g;
  g.row_begin = {0, 0};
  g.masses = {2.0};
  const CsrGraph graph(g);
  const LogMap map = LogMapSolver(graph).solve(Source::at_vertex(Vertex{0}));
  EXPECT_EQ(map.status(Vertex{0}), Status::ok);
  EXPECT_EQ(map.distance(Vertex{0}), 0.0);
}

TEST(Reach, SurvivesMassesOverTwentyOrdersOfMagnitude) {
  FlatGraph flat = planar_triangulation(12);
  for (std::size_t i = 0; i < flat.data.masses.size(); ++i)
    flat.data.masses[i] *= std::pow(10.0, -20.0 * (i % 5) / 4.0);
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph);
  for (Index p : {3, 4, 70}) {
    const LogMap map = solver.solve(Source::at_vertex(Vertex(p)));
    for (Index i = 0; i < flat.size(); ++i) {
      ASSERT_EQ(map.status(Vertex(i)), Status::ok);
      ASSERT_NEAR(map.coordinates(Vertex(i))[0], flat.exact(p, i)[0], 1e-11 * flat.diameter());
    }
  }
}

}  // namespace
}  // namespace ahm::test
