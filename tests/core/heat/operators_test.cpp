// The factored operators against what they are made of, and factorizations that must not pass as good.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

/// c (m_i x_i + tau sum_j w_ij (x_i - R_ji x_j)), with R = 1 for scalars: the operators as the paper writes them.
std::vector<double> apply(const CsrGraph& graph, const HeatOperators& heat, const std::vector<double>& x,
                          bool vectors) {
  std::vector<double> y(x.size());
  const std::size_t width = vectors ? 2 : 1;
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    double sum[2] = {0, 0};
    for (std::size_t a = 0; a < width; ++a) sum[a] = graph.mass(i) * x[i * width + a];
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const double w = heat.tau()[0] * star.weights[e];
      const double* other = x.data() + star.neighbors[e] * static_cast<Index>(width);
      const double c = star.transports[2 * e], s = star.transports[2 * e + 1];
      const double carried[2] = {vectors ? c * other[0] - s * other[1] : other[0],
                                 vectors ? s * other[0] + c * other[1] : 0.0};
      for (std::size_t a = 0; a < width; ++a) sum[a] += w * (x[i * width + a] - carried[a]);
    }
    for (std::size_t a = 0; a < width; ++a) y[i * width + a] = heat.scaling() * sum[a];
  }
  return y;
}

TEST(HeatOperators, InvertTheirDefinition) {
  const CsrGraph graph(sphere_graph(300));
  const HeatOperators heat(graph, {.t_coef = 3.0});
  EXPECT_DOUBLE_EQ(heat.tau()[0], 3.0 * graph.mean_edge_length() * graph.mean_edge_length());
  for (bool vectors : {false, true}) {
    std::vector<double> x(static_cast<std::size_t>(graph.size()) * (vectors ? 2 : 1));
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(1.0 + 3.7 * static_cast<double>(k));
    std::vector<double> solved = apply(graph, heat, x, vectors);
    vectors ? heat.solve_vector(solved, 1) : heat.solve_scalar(solved, 1);
    for (std::size_t k = 0; k < x.size(); ++k) ASSERT_NEAR(solved[k], x[k], 1e-12);
  }
}

TEST(HeatOperators, SolveColumnsIndependently) {
  const CsrGraph graph(sphere_graph(100));
  const HeatOperators heat(graph);
  std::vector<double> both(200, 0.0), first(100, 0.0);
  both[3] = first[3] = 1.0;
  both[107] = 1.0;
  heat.solve_scalar(both, 2);
  heat.solve_scalar(first, 1);
  for (std::size_t i = 0; i < 100; ++i) ASSERT_NEAR(both[i], first[i], 1e-15);
  EXPECT_NEAR(both[7], both[103], 1e-15);  // A is symmetric: heat from 3 at 7 is heat from 7 at 3
  EXPECT_THROW(heat.solve_scalar(first, 2), InvalidArgument);
  EXPECT_THROW(heat.solve_vector(first, 1), InvalidArgument);
  std::vector<double> none;
  EXPECT_NO_THROW(heat.solve_scalar(none, 0));
}

TEST(HeatOperators, RefuseAnIndefiniteOperator) {
  CsrGraphData g = sphere_graph(60);
  for (double& w : g.weights) w = -w;
  const CsrGraph graph(g);
  EXPECT_THROW(HeatOperators{graph}, NotPositiveDefinite);
}

/// Where digits do not reach, B's pivots may fail, too: what is wrong with A is told.
TEST(HeatOperators, TellOfLostHeatBeforeB) {
  for (const Index side : {20, 40, 60, 150}) {
    const CsrGraph graph(planar_triangulation(side).data);
    for (const double t_coef : {1e16, 1e17, 1e18, 1e19})
      for (const unsigned threads : {1u, 2u}) try {
          const HeatOperators heat(graph, {.t_coef = t_coef, .threads = threads});
          ADD_FAILURE() << side << ", " << t_coef;
        } catch (const NotPositiveDefinite& error) {
          const bool is_of_A =
              error.fault() == "heat_lost" || std::string(error.what()).find(" A ") != std::string::npos;
          EXPECT_TRUE(is_of_A) << error.what();
        }
  }
}

TEST(HeatOperators, RefuseABrokenGraphBeforeFactoring) {
  CsrGraphData g = sphere_graph(60);
  g.masses[17] = NAN;
  const CsrGraph graph(g);
  EXPECT_THROW(HeatOperators{graph}, InvalidGraph);
  EXPECT_THROW(HeatOperators(graph, {.check_graph = false}), Error);  // the factorization's own checks catch it too
}

TEST(HeatOperators, RefuseTimesThatLeaveNoDigits) {
  const CsrGraph graph(sphere_graph(300));
  EXPECT_NO_THROW(HeatOperators(graph, {.t_coef = 1e4}));
  for (double t_coef : {1e12, 1e16, 1e25, 1e200})
    EXPECT_THROW(HeatOperators(graph, {.t_coef = t_coef}), Error) << t_coef;
}

TEST(HeatOperators, ServeEdgesAThousandTimesAsLongAsOthersAtLongTimes) {
  // Around a tube 64 edges of 0.1, along it 39 of 100: rounding adds up to the same side everywhere.
  Mesh tube;
  constexpr Index around = 64, along = 40;
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const double turn = 2 * std::numbers::pi * j / around;
      tube.positions.push_back({std::cos(turn), std::sin(turn), 100.0 * i});
    }
  for (Index i = 0; i + 1 < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around + j, b = i * around + (j + 1) % around;
      tube.faces.push_back({a, b, b + around});
      tube.faces.push_back({a, b + around, a + around});
    }
  const auto surface = trimesh::TriangleMeshSurface::build(tube.positions, tube.faces);
  const auto map = LogMapSolver(surface.graph(), {.t_coef = 30}).solve(Source::at_vertex(Vertex{0}));
  for (Index i = 3; i < along; ++i)  // where the way round is nothing beside the way along
    for (Index j = 0; j < around; ++j) {
      const auto phi = map.coordinates(Vertex(i * around + j));
      ASSERT_NEAR(std::hypot(phi[0], phi[1]), 100.0 * i, 0.01 * 100 * i);
    }
}

TEST(HeatOperators, RefuseGraphsWithoutDigitsForTheirTime) {
  const CsrGraph graph(scaled(sphere_graph(60), 1e-170));
  EXPECT_THROW(HeatOperators(graph, {}), InvalidGraph);
}

TEST(LinearAlgebra, SaysWhatItRunsOn) {
  const LinearAlgebraInfo info = linear_algebra_info();
  EXPECT_FALSE(info.cholmod.empty());
  EXPECT_FALSE(info.blas.empty());
}

}  // namespace
}  // namespace ahm::test
