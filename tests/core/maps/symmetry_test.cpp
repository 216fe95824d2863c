// What must not change the map, and what must change it in a known way, beside the laws of the graph contract.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

std::vector<double> solve(const CsrGraphData& data, Index p, Variant variant, HeatOptions options = {}) {
  const CsrGraph graph(data);
  const LogMap map = LogMapSolver(graph, options).solve(Source::at_vertex(Vertex(p)), {.variant = variant});
  return {map.coordinates().begin(), map.coordinates().end()};
}

double largest(const std::vector<double>& values) {
  double m = 0;
  for (double v : values) m = std::max(m, std::abs(v));
  return m;
}

void expect_close(const std::vector<double>& a, const std::vector<double>& b, double gate) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], gate * largest(b)) << "number " << k;
}

class Symmetry : public testing::TestWithParam<Variant> {
 protected:
  const CsrGraphData sphere = sphere_graph(400);
};

TEST_P(Symmetry, ScalesBitwiseByPowersOfTwo) {
  const auto map = solve(sphere, 5, GetParam());
  for (int exponent : {-300, 300}) {
    const auto other = solve(scaled(sphere, std::ldexp(1.0, exponent)), 5, GetParam());
    for (std::size_t k = 0; k < map.size(); ++k) ASSERT_EQ(other[k], std::ldexp(map[k], exponent));
  }
}

TEST_P(Symmetry, MultipliesByTheLengthUnit) {
  CsrGraphData in_units = sphere;
  in_units.length_unit = 1024.0;
  const auto map = solve(sphere, 5, GetParam()), other = solve(in_units, 5, GetParam());
  for (std::size_t k = 0; k < map.size(); ++k) ASSERT_EQ(other[k], 1024.0 * map[k]);
}

TEST_P(Symmetry, RotatesWithTheSourceFrame) {
  const CsrGraph graph(sphere);
  const LogMapSolver solver(graph);
  const double angle = 0.7, direction[] = {3 * std::cos(angle), 3 * std::sin(angle)};
  const LogMap map = solver.solve(Source::at_vertex(Vertex{9}), {.variant = GetParam()});
  const LogMap turned = solver.solve(Source::at_vertex(Vertex{9}, direction), {.variant = GetParam()});
  for (Index i = 0; i < graph.size(); ++i) {
    const double x = map.coordinates(Vertex(i))[0], y = map.coordinates(Vertex(i))[1];
    ASSERT_NEAR(turned.coordinates(Vertex(i))[0], std::cos(angle) * x + std::sin(angle) * y, 1e-11);
    ASSERT_NEAR(turned.coordinates(Vertex(i))[1], std::cos(angle) * y - std::sin(angle) * x, 1e-11);
  }
}

TEST_P(Symmetry, ConjugatesWithTheOrientation) {
  auto map = solve(sphere, 5, GetParam());
  for (std::size_t i = 0; i < map.size(); i += 2) map[i + 1] *= -1;
  expect_close(solve(mirrored(sphere), 5, GetParam()), map, 1e-11);
}

TEST_P(Symmetry, IsTheSameOnComplexNumbersAndOnBlocks) {
  expect_close(solve(as_blocks(sphere), 5, GetParam()), solve(sphere, 5, GetParam()), 1e-11);
}

TEST_P(Symmetry, RepeatsBitwise) { EXPECT_EQ(solve(sphere, 5, GetParam()), solve(sphere, 5, GetParam())); }

TEST_P(Symmetry, IsTheSameForEveryOrdering) {
  const auto map = solve(sphere, 5, GetParam());
  expect_close(solve(sphere, 5, GetParam(), {.ordering = Ordering::nested_dissection}), map, 1e-11);
  expect_close(solve(as_blocks(sphere), 5, GetParam(), {.ordering = Ordering::nested_dissection}), map, 1e-11);
}

TEST_P(Symmetry, HasTheSourceAtTheOrigin) {
  const auto map = solve(sphere, 5, GetParam(), {.t_coef = 1e-3});
  // With ever shorter times the source's own coordinates vanish.
  EXPECT_LT(std::hypot(map[10], map[11]), 1e-3 * largest(map));
}

INSTANTIATE_TEST_SUITE_P(Variants, Symmetry, testing::ValuesIn(all_variants),
                         [](const auto& info) { return std::string(to_string(info.param)); });

}  // namespace
}  // namespace ahm::test
