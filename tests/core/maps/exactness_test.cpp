// The log map of flat space is the identity, to rounding, whatever the graph, its weights, masses and frames (Remark 2,
// App. B).
#include <gtest/gtest.h>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

constexpr double gate = 1e-11;  // of the diameter

void expect_identity(const FlatGraph& flat, const LogMap& map, Index p) {
  for (Index i = 0; i < flat.size(); ++i) {
    ASSERT_EQ(map.status(Vertex(i)), Status::ok);
    const auto exact = flat.exact(p, i);
    for (int a = 0; a < flat.dimension; ++a)
      ASSERT_NEAR(map.coordinates(Vertex(i))[a], exact[a], gate * flat.diameter())
          << "vertex " << i << ", source " << p;
  }
}

void expect_identity_from_everywhere(const FlatGraph& flat, double t_coef) {
  const CsrGraph graph(flat.data);
  const LogMapSolver solver(graph, {.t_coef = t_coef});
  for (Variant variant : all_variants)
    for (Index p : {Index{0}, flat.size() / 2, flat.size() / 3, flat.size() - 1})
      expect_identity(flat, solver.solve(Source::at_vertex(Vertex(p)), {.variant = variant}), p);
}

TEST(LogMap, IsExactOnAnyPlanarTriangulation) {
  const FlatGraph flat = planar_triangulation(24);
  for (double t_coef : {0.1, 1.0, 100.0}) expect_identity_from_everywhere(flat, t_coef);
}

TEST(LogMap, IsExactOnPlanesWithMirroredFrames) {
  expect_identity_from_everywhere(planar_triangulation(16, TransportKind::block, true), 1.0);
}

TEST(LogMap, IsExactOnALine) { expect_identity_from_everywhere(line_graph(50), 1.0); }

TEST(LogMap, IsExactInThreeDimensions) { expect_identity_from_everywhere(lattice3(7), 1.0); }

TEST(LogMap, IsExactWithParallelEdges) {
  FlatGraph flat = planar_triangulation(8);
  // Split every edge into two parallel ones of a third and two thirds of its weight.
  CsrGraphData& g = flat.data;
  CsrGraphData split = g;
  split.neighbors.clear(), split.weights.clear(), split.logs.clear(), split.transports.clear();
  for (Offset& begin : split.row_begin) begin *= 2;
  for (std::size_t e = 0; e < g.neighbors.size(); ++e)
    for (double share : {1.0 / 3, 2.0 / 3}) {
      split.neighbors.push_back(g.neighbors[e]);
      split.weights.push_back(share * g.weights[e]);
      for (int a = 0; a < 2; ++a) {
        split.logs.push_back(g.logs[2 * e + a]);
        split.transports.push_back(g.transports[2 * e + a]);
      }
    }
  g = split;
  expect_identity_from_everywhere(flat, 1.0);
}

TEST(LogMap, IsExactFromASourceBetweenVertices) {
  for (TransportKind kind : {TransportKind::rotation2, TransportKind::block}) {
    const FlatGraph flat = planar_triangulation(12, kind, kind == TransportKind::block);
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    // A point in the middle of three vertices; its frame is that of the plane.
    const Index corners[] = {40, 41, 53};
    const double weights[] = {0.2, 0.5, 0.3};
    double p[2] = {0, 0};
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 2; ++a) p[a] += weights[k] * flat.positions[corners[k] * 2 + a];
    Source source(2);
    for (int k = 0; k < 3; ++k) {
      const double offset[] = {flat.positions[corners[k] * 2] - p[0], flat.positions[corners[k] * 2 + 1] - p[1]};
      source.add(Vertex(corners[k]), weights[k], offset, std::span(flat.frames).subspan(corners[k] * 4, 4));
    }
    for (Variant variant : all_variants) {
      const LogMap map = solver.solve(source, {.variant = variant});
      for (Index i = 0; i < flat.size(); ++i)
        for (int a = 0; a < 2; ++a)
          ASSERT_NEAR(map.coordinates(Vertex(i))[a], flat.positions[i * 2 + a] - p[a], gate * flat.diameter());
    }
  }
}

TEST(LogMap, IsExactFromAStraightCurve) {
  // Every vertex of one row of the grid is a sample; the parameterization is the plane's own.
  const FlatGraph flat = planar_triangulation(12);
  const CsrGraph graph(flat.data);
  Source curve(2);
  for (Index k = 60; k < 72; ++k)
    curve.add(Vertex(k), 1.0 + 0.1 * k, std::span(flat.positions).subspan(2 * k, 2),
              std::span(flat.frames).subspan(4 * k, 4));
  const LogMapSolver solver(graph);
  for (Variant variant : all_variants) {
    const LogMap map = solver.solve(curve, {.variant = variant});
    for (Index i = 0; i < flat.size(); ++i)
      for (int a = 0; a < 2; ++a)
        ASSERT_NEAR(map.coordinates(Vertex(i))[a], flat.positions[i * 2 + a], gate * flat.diameter());
  }
}

}  // namespace
}  // namespace ahm::test
