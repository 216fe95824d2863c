// Laws of all methods on a graph, independent of their accuracy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <string>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "methods/signed_heat.hpp"

namespace ahm::test {
namespace {

using methods::Method;
using methods::Result;

struct Case {
  std::string name;
  std::function<Method(const TangentGraph&)> make;
};

class BaselineContract : public testing::TestWithParam<Case> {
 protected:
  Result solve(CsrGraphData data, Index source) const {
    const CsrGraph graph(std::move(data));
    return GetParam().make(graph)->solve(source);
  }
};

std::vector<CsrGraphData> graphs() { return {sphere_graph(300), as_blocks(sphere_graph(300, 2)), bent_lattice(6)}; }

double largest(const std::vector<double>& values) {
  double result = 0;
  for (double x : values)
    if (std::isfinite(x)) result = std::max(result, std::abs(x));
  return result;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << "entry " << i;
}

TEST_P(BaselineContract, IsFiniteAndZeroAtTheSource) {
  for (const CsrGraphData& data : graphs()) {
    const Result result = solve(data, 7);
    EXPECT_EQ(result.distance.size(), data.masses.size());
    for (double d : result.distance) ASSERT_TRUE(std::isfinite(d));
    if (!result.coordinates.empty())
      ASSERT_EQ(result.coordinates.size(), data.masses.size() * static_cast<std::size_t>(data.dimension));
    for (double x : result.coordinates) ASSERT_TRUE(std::isfinite(x));
    // On a curved graph, heat that returns to the source is rotated, which moves the source slightly in the affine heat
    // method.
    if (GetParam().name != "AffineHeat") EXPECT_NEAR(result.distance[7], 0, 1e-12);
  }
}

TEST_P(BaselineContract, IsSilentRatherThanWrongFarAway) {
  const Index rings = 1500, around = 6;
  const Result result = solve(tube(rings, around), 0);
  for (Index ring = 0; ring < rings; ++ring)
    for (Index k = 0; k < around; ++k)
      if (const double d = result.distance[ring * around + k]; std::isfinite(d) || ring < 300)
        ASSERT_NEAR(d, ring, 0.05 * ring + around) << "ring " << ring;
}

TEST_P(BaselineContract, TurnsWithTheSourceFrameAndNoOther) {
  for (const CsrGraphData& data : graphs()) {
    const Result result = solve(data, 7);
    const TurnedGraph turned = with_frames_turned(data);
    const Result other = solve(turned.data, 7);
    const int d = data.dimension;
    const double tolerance = 1e-9 * largest(result.distance);
    expect_near(result.distance, other.distance, tolerance);
    std::vector<double> expected(result.coordinates.size(), 0.0);
    for (std::size_t i = 0; i < expected.size(); i += static_cast<std::size_t>(d))
      for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) expected[i + a] += turned.turns[(7 * d + a) * d + b] * result.coordinates[i + b];
    expect_near(expected, other.coordinates, tolerance);
  }
}

TEST_P(BaselineContract, ScalesWithTheGraph) {
  for (const CsrGraphData& data : graphs()) {
    Result result = solve(data, 7);
    const Result other = solve(scaled(data, 1024.0), 7);
    for (double& x : result.distance) x *= 1024;
    for (double& x : result.coordinates) x *= 1024;
    expect_near(result.distance, other.distance, 1e-9 * largest(result.distance));
    expect_near(result.coordinates, other.coordinates, 1e-9 * largest(result.distance));
  }
}

TEST_P(BaselineContract, SpeaksInOutsideUnits) {
  CsrGraphData data = sphere_graph(300);
  Result result = solve(data, 7);
  data.length_unit = 0.125;
  for (double& x : result.distance) x *= 0.125;
  for (double& x : result.coordinates) x *= 0.125;
  const Result other = solve(data, 7);
  expect_near(result.distance, other.distance, 1e-12);
  expect_near(result.coordinates, other.coordinates, 1e-12);
}

TEST_P(BaselineContract, DoesNotDependOnTheNumbering) {
  for (const CsrGraphData& data : graphs()) {
    const auto n = data.masses.size(), d = static_cast<std::size_t>(data.dimension);
    std::vector<Index> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    const Result result = solve(data, 7), other = solve(relabeled(data, order), order[7]);
    const double tolerance = 1e-9 * largest(result.distance);
    for (std::size_t i = 0; i < n; ++i) {
      const auto j = static_cast<std::size_t>(order[i]);
      ASSERT_NEAR(result.distance[i], other.distance[j], tolerance);
      for (std::size_t a = 0; a < d && !result.coordinates.empty(); ++a)
        ASSERT_NEAR(result.coordinates[i * d + a], other.coordinates[j * d + a], tolerance);
    }
  }
}

TEST_P(BaselineContract, AgreesOnRotationsAndBlocks) {
  const CsrGraphData data = sphere_graph(300);
  const Result result = solve(data, 7), other = solve(as_blocks(data), 7);
  expect_near(result.distance, other.distance, 1e-9);
  expect_near(result.coordinates, other.coordinates, 1e-9);
}

TEST_P(BaselineContract, SaysNothingAboutOtherComponents) {
  const CsrGraphData data = sphere_graph(300);
  const std::size_t n = data.masses.size();
  for (const std::size_t copy : {std::size_t{0}, n}) {
    const Result result = solve(doubled(data), static_cast<Index>(7 + copy));
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const bool same = (i < n) == (copy == 0);
      ASSERT_EQ(std::isfinite(result.distance[i]), same);
      if (!result.coordinates.empty()) ASSERT_EQ(std::isfinite(result.coordinates[2 * i]), same);
    }
  }
}

TEST_P(BaselineContract, RefusesASourceThatIsNoVertex) {
  const CsrGraph graph(sphere_graph(300));
  const Method method = GetParam().make(graph);
  EXPECT_THROW(method->solve(-1), InvalidArgument);
  EXPECT_THROW(method->solve(graph.size()), InvalidArgument);
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Case cases[] = {
    {"AffineHeat", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::adaptive); }},
    {"DiscreteExponential", [](const TangentGraph& g) { return methods::discrete_exponential(g); }},
    {"DiscreteExponentialAveraged",
     [](const TangentGraph& g) { return methods::discrete_exponential(g, {.upwind_average = true}); }},
    {"HeatDistance", [](const TangentGraph& g) { return methods::heat_distance(g); }},
    {"SmoothedExponential", [](const TangentGraph& g) { return methods::smoothed_exponential(g); }},
    {"SignedHeat", [](const TangentGraph& g) -> Method { return std::make_unique<methods::SignedHeat>(g); }},
    {"VectorHeatLog", [](const TangentGraph& g) { return methods::vector_heat_log(g); }},
    {"VectorHeatLogRadial",
     [](const TangentGraph& g) { return methods::vector_heat_log(g, {.radial_at_source = true}); }},
};
INSTANTIATE_TEST_SUITE_P(Methods, BaselineContract, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

}  // namespace
}  // namespace ahm::test
