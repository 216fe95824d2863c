// Every law of a tangent graph, broken once, is found and named.
#include "ahm/graph/validate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {
namespace {

template <class Break>
void expect_invalid(CsrGraphData g, const Break& breaking, const std::string& text) {
  breaking(g);
  try {
    const CsrGraph graph(g);
    validate(graph);
    ADD_FAILURE() << "no error; expected one that says: " << text;
  } catch (const InvalidGraph& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

TEST(Validate, AcceptsSoundGraphs) {
  EXPECT_NO_THROW(validate(CsrGraph(sphere_graph(80))));
  EXPECT_NO_THROW(validate(CsrGraph(planar_triangulation(6, TransportKind::block, true).data)));
  EXPECT_NO_THROW(validate(CsrGraph(lattice3(4).data)));
}

TEST(Validate, NamesTheFirstBrokenLawOnAnyNumberOfThreads) {
  CsrGraphData g = sphere_graph(40000);  // more than one chunk of vertices
  g.weights[g.row_begin[39000]] *= 2;
  g.masses[38000] = 0;
  for (const unsigned threads : {1U, 4U})
    for (int run = 0; run < 5; ++run) try {
        validate(CsrGraph(g), threads);
        ADD_FAILURE();
      } catch (const InvalidGraph& e) {
        EXPECT_NE(std::string(e.what()).find("mass of vertex 38000"), std::string::npos) << e.what();
      }
  g.masses[38000] = 1;
  g.weights[g.row_begin[100]] *= 2;
  for (const unsigned threads : {1U, 4U}) try {
      validate(CsrGraph(g), threads);
      ADD_FAILURE();
    } catch (const InvalidGraph& e) {
      EXPECT_NE(std::string(e.what()).find("100"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("another weight"), std::string::npos) << e.what();
    }
}

TEST(Validate, NamesTheBrokenLaw) {
  const CsrGraphData g = sphere_graph(80);
  expect_invalid(
      g, [](auto& b) { b.masses[7] = 0; }, "mass of vertex 7");
  expect_invalid(
      g, [](auto& b) { b.masses[7] = INFINITY; }, "mass of vertex 7");
  expect_invalid(
      g, [](auto& b) { b.weights[0] = NAN; }, "weight is not finite");
  expect_invalid(
      g, [](auto& b) { b.weights[0] *= 1.001; }, "another weight");
  expect_invalid(
      g,
      [](auto& b) {
        b.logs[3] = NAN;
        b.mean_edge_length = 1.0;
      },
      "logarithm is not finite");
  expect_invalid(
      g, [](auto& b) { b.transports[0] *= 1.01; }, "not orthogonal");
  expect_invalid(
      g, [](auto& b) { std::swap(b.transports[0], b.transports[1]); }, "not inverse");
  expect_invalid(
      g, [](auto& b) { b.neighbors[0] = 0; }, "self loops");
  expect_invalid(
      g, [](auto& b) { b.neighbors[0] = 79; }, "edge 0 -> 79");
  expect_invalid(
      g, [](auto& b) { b.neighbors[0] = 80; }, "outside [0, 80)");
  expect_invalid(
      g, [](auto& b) { b.mean_edge_length = 0.0; }, "mean edge length");
  for (const double unit : {0.0, -1.0, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    expect_invalid(
        g, [&](auto& b) { b.length_unit = unit; }, "unit of length");
  expect_invalid(
      g, [](auto& b) { b.weights.pop_back(); }, "'weights' has length");
  expect_invalid(
      g, [](auto& b) { b.row_begin[3] = 100000; }, "row_begin");
  expect_invalid(
      CsrGraphData{.row_begin = {0}}, [](auto&) {}, "no vertices");
  expect_invalid(
      line_graph(4).data,
      [](auto& b) {
        b.kind = TransportKind::rotation2;
        b.transports.resize(12);
      },
      "dimension 2");
}

TEST(Validate, FindsStarsOfAnotherDimension) {
  struct Wrong final : TangentGraph {
    CsrGraph plane{sphere_graph(60)};
    Index size() const noexcept override { return plane.size(); }
    int dimension() const noexcept override { return 2; }
    TransportKind transport_kind() const noexcept override { return TransportKind::rotation2; }
    double mean_edge_length() const noexcept override { return plane.mean_edge_length(); }
    double mass(Index i) const override { return plane.mass(i); }
    Offset edge_count() const noexcept override { return plane.edge_count(); }
    Star star(Index i) const override {
      Star s = plane.star(i);
      s.dimension = 1;
      return s;
    }
  };
  EXPECT_THROW(validate(Wrong{}), InvalidGraph);
}

TEST(Validate, FindsAMissingReverseEdge) {
  CsrGraphData g = sphere_graph(80);
  // Turn the last edge of the last vertex into a second edge to its first neighbour.
  g.neighbors.back() = g.neighbors[g.row_begin[79]];
  EXPECT_THROW(validate(CsrGraph(g)), InvalidGraph);
}

}  // namespace
}  // namespace ahm::test
