// What A and B give besides log maps, on the plane where the answers are known.
#include "ahm/fields/vector_heat.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"

namespace ahm::test {
namespace {

class VectorHeat : public testing::TestWithParam<TransportKind> {
 protected:
  VectorHeat()
      : flat(planar_triangulation(14, GetParam(), GetParam() == TransportKind::block)),
        graph(flat.data),
        solver(graph) {}
  FlatGraph flat;
  CsrGraph graph;
  LogMapSolver solver;
};

TEST_P(VectorHeat, ExtendsAConstantAsTheConstant) {
  for (double value : {-3.0, 0.0, 1e-30, 7e200}) {
    const auto field =
        extend_scalar(solver, std::array{Vertex{3}, Vertex{50}, Vertex{120}}, std::array{value, value, value});
    for (double v : field.values) ASSERT_NEAR(v, value, 1e-12 * std::abs(value));
  }
}

TEST_P(VectorHeat, ExtendsByTheShareEachSourceHasInTheHeat) {
  const auto field = extend_scalar(solver, std::array{Vertex{0}, Vertex{195}}, std::array{-1.0, 1.0});
  std::vector<double> heat(2 * static_cast<std::size_t>(flat.size()), 0.0);  // of the two sources, one after the other
  heat[0] = heat[heat.size() - 1 - static_cast<std::size_t>(flat.size() - 196)] = 1.0;
  solver.operators().solve_scalar(heat, 2);
  for (Index i = 0; i < flat.size(); ++i) {
    const double first = heat[i], second = heat[i + flat.size()];
    ASSERT_NEAR(field.values[i], (second - first) / (second + first), 1e-12) << "vertex " << i;
  }
  EXPECT_LT(field.values[0], field.values[195]);
}

TEST_P(VectorHeat, CarriesVectorsWithoutChangeOnThePlane) {
  const std::vector<double> vector{2.0, -1.5};
  const auto field = transport_vectors(solver, std::array{Vertex{20}}, vector);
  for (Index i = 0; i < flat.size(); ++i) {
    const auto expected = flat.carried(20, i, vector);
    for (int a = 0; a < 2; ++a) ASSERT_NEAR(field.values[i * 2 + a], expected[a], 1e-11);
  }
}

/// A point of a flat graph beside a vertex, at z in its frame, as a source on the vertex and its neighbours.
Source beside(const FlatGraph& flat, const CsrGraph& graph, Index vertex, const std::array<double, 2>& z) {
  Source source(2);
  const auto add = [&](Index i, double weight) {
    const auto at = flat.exact(vertex, i);
    const auto u = flat.carried(vertex, i, std::vector{1.0, 0.0}), v = flat.carried(vertex, i, std::vector{0.0, 1.0});
    source.add(Vertex{i}, weight, std::array{at[0] - z[0], at[1] - z[1]}, std::array{u[0], v[0], u[1], v[1]});
  };
  add(vertex, 0.4);
  for (Index i : graph.star(vertex).neighbors) add(i, 0.6 / static_cast<double>(graph.star(vertex).degree()));
  return source;
}

TEST_P(VectorHeat, CarriesVectorsFromPointsBetweenVertices) {
  const std::vector<double> vector{2.0, -1.5};
  const std::array points{beside(flat, graph, 20, {0.02, 0.01}), beside(flat, graph, 100, {-0.01, 0.03})};
  std::vector<double> given = vector;
  for (double x : flat.carried(20, 100, vector)) given.push_back(x);
  const auto field = transport_vectors(solver, points, given);
  for (Index i = 0; i < flat.size(); ++i) {
    const auto expected = flat.carried(20, i, vector);
    for (int a = 0; a < 2; ++a) ASSERT_NEAR(field.values[i * 2 + a], expected[a], 1e-10);
  }
  const auto same = extend_scalar(solver, points, std::array{4.0, 4.0});
  for (double v : same.values) ASSERT_NEAR(v, 4.0, 1e-11);
}

TEST_P(VectorHeat, TakesVerticesAsPoints) {
  const std::array vertices{Vertex{3}, Vertex{50}};
  const std::array points{Source::at_vertex(Vertex{3}), Source::at_vertex(Vertex{50})};
  const std::array values{1.0, 3.0};
  const std::array vectors{1.0, 2.0, -0.5, 0.25};
  EXPECT_EQ(extend_scalar(solver, points, values).values, extend_scalar(solver, vertices, values).values);
  EXPECT_EQ(transport_vectors(solver, points, vectors).values, transport_vectors(solver, vertices, vectors).values);
}

TEST_P(VectorHeat, CarriesTheSourceFrameOnThePlane) {
  const auto field = parallel_transport(solver, Source::at_vertex(Vertex{20}));
  for (Index i = 0; i < flat.size(); ++i)
    for (int axis = 0; axis < 2; ++axis) {
      const auto expected = flat.carried(20, i, axis == 0 ? std::vector{1.0, 0.0} : std::vector{0.0, 1.0});
      for (int c = 0; c < 2; ++c) ASSERT_NEAR(field.values[i * 4 + c * 2 + axis], expected[c], 1e-11);
    }
}

TEST_P(VectorHeat, HasTheRadialFieldOfThePlane) {
  const auto field = radial_field(solver, Source::at_vertex(Vertex{20}));
  for (Index i = 0; i < flat.size(); ++i) {
    const auto back = flat.exact(i, 20);  // the source seen from i: Y = -log_i(p)
    for (int a = 0; a < 2; ++a) ASSERT_NEAR(field.values[i * 2 + a], -back[a], 1e-11);
  }
}

TEST_P(VectorHeat, MasksOtherComponents) {
  const CsrGraph two(doubled(flat.data));
  const LogMapSolver solver_of_two(two);
  const auto field = extend_scalar(solver_of_two, std::array{Vertex{0}}, std::array{1.0});
  EXPECT_EQ(field.status[flat.size()], Status::disconnected);
  EXPECT_TRUE(std::isnan(field.values[flat.size()]));
}

TEST_P(VectorHeat, RefusesNonsense) {
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{0}}, std::array<double, 1>{NAN}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{0}}, std::array{1.0, 2.0}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{-5}}, std::array{1.0}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::span<const Vertex>(), std::span<const double>()), InvalidArgument);
  EXPECT_THROW(transport_vectors(solver, std::array{Vertex{0}}, std::array{1.0}), InvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(Kinds, VectorHeat, testing::Values(TransportKind::rotation2, TransportKind::block),
                         [](const auto& info) { return info.param == TransportKind::block ? "block" : "rotation2"; });

}  // namespace
}  // namespace ahm::test
