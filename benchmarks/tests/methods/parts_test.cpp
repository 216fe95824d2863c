// The steps that the methods share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ahm/conformance/flat_graphs.hpp"
#include "methods/edge_integration.hpp"
#include "methods/heat_fields.hpp"

namespace ahm::test {
namespace {

std::vector<FlatGraph> flat_graphs() {
  return {planar_triangulation(20), planar_triangulation(20, TransportKind::block, true), lattice3(7), line_graph(30)};
}

/// Components, in the frame of a vertex, of a vector of the ambient R^d.
Eigen::VectorXd in_frame(const FlatGraph& g, Index i, const Eigen::VectorXd& vector) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(&g.frames[i * g.dimension * g.dimension], g.dimension, g.dimension) * vector;
}

Eigen::VectorXd position(const FlatGraph& g, Index i) {
  return Eigen::Map<const Eigen::VectorXd>(&g.positions[i * g.dimension], g.dimension);
}

TEST(EdgeIntegration, IsExactForQuadraticsOnFlatGraphs) {
  for (const FlatGraph& g : flat_graphs()) {
    const CsrGraph graph(g.data);
    const int d = g.dimension;
    const Eigen::MatrixXd half = Eigen::MatrixXd::Random(d, d), Q = half + half.transpose();
    const Eigen::VectorXd linear = Eigen::VectorXd::Random(d);
    auto value = [&](Index i) { return 0.5 * position(g, i).dot(Q * position(g, i)) + linear.dot(position(g, i)); };
    std::vector<double> field;
    for (Index i = 0; i < g.size(); ++i)
      for (double x : in_frame(g, i, Q * position(g, i) + linear)) field.push_back(x);
    const std::vector<double> f = methods::EdgeIntegration(graph).integrate(field);
    double scale = 0;
    for (Index i = 0; i < g.size(); ++i) scale = std::max(scale, std::abs(value(i)));
    for (Index i = 0; i < g.size(); ++i) ASSERT_NEAR(f[i] - f[0], value(i) - value(0), 1e-11 * scale) << "d = " << d;
  }
}

TEST(StarGradient, IsExactForLinearFunctionsOnFlatGraphs) {
  for (const FlatGraph& g : flat_graphs()) {
    const CsrGraph graph(g.data);
    const Eigen::VectorXd slope = Eigen::VectorXd::Random(g.dimension);
    methods::StarGradient gradient(g.dimension);
    for (Index i = 0; i < g.size(); ++i) {
      const Star star = graph.star(i);
      std::vector<double> increments;
      for (Index j : star.neighbors) increments.push_back(slope.dot(position(g, j) - position(g, i)));
      const Eigen::VectorXd exact = in_frame(g, i, slope), fitted = gradient.fit(star, increments);
      ASSERT_LT((fitted - exact).norm(), 1e-9) << "d = " << g.dimension << ", vertex " << i;
      const Eigen::Map<const Eigen::VectorXd> steps(increments.data(), static_cast<Eigen::Index>(increments.size()));
      ASSERT_LT((gradient.coefficients(star) * steps - exact).norm(), 1e-9);
    }
  }
}

TEST(Carrying, GoesThereAndBack) {
  for (const FlatGraph& g : flat_graphs()) {
    const CsrGraph graph(g.data);
    const Eigen::VectorXd vector = Eigen::VectorXd::Random(g.dimension);
    for (Index i = 0; i < g.size(); ++i) {
      const Star star = graph.star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const Eigen::VectorXd there = in_frame(g, star.neighbors[e], vector), here = in_frame(g, i, vector);
        Eigen::VectorXd carried(g.dimension);
        methods::carry_here(graph, star, e, there.data(), carried.data());
        ASSERT_LT((carried - here).norm(), 1e-12);
        methods::carry_there(graph, star, e, here.data(), carried.data());
        ASSERT_LT((carried - there).norm(), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace ahm::test
