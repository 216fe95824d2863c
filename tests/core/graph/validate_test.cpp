// Every law of a tangent graph, broken once, is reported by name.
#include "ahm/graph/validate.hpp"

#include <functional>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

TEST(Validate, AcceptsValidGraphs) {
  EXPECT_NO_THROW(validate(CsrGraph(sphere_graph(80))));
  EXPECT_NO_THROW(validate(CsrGraph(planar_triangulation(6, TransportKind::block, true).data)));
  EXPECT_NO_THROW(validate(CsrGraph(lattice3(4).data)));
}

TEST(Validate, NamesTheFirstBrokenLawOnAnyNumberOfThreads) {
  CsrGraphData g = sphere_graph(40000);  // more than one chunk of vertices
  g.weights[g.row_begin[39000]] *= 2;
  const auto expect_first = [&](const std::string& text) {
    for (const unsigned threads : {1, 4, 4, 4, 4, 4})
      expect_error<InvalidGraph>([&] { validate(CsrGraph(g), threads); }, text);
  };
  g.masses[38000] = 0;
  expect_first("mass of vertex 38000");
  g.masses[38000] = 1;
  g.weights[g.row_begin[100]] *= 2;
  expect_first("100");
  expect_first("another weight");
}

TEST(Validate, NamesTheBrokenLaw) {
  const struct {
    const char* law;
    std::function<void(CsrGraphData&)> break_law;
  } cases[] = {
      {"mass of vertex 7", [](auto& g) { g.masses[7] = 0; }},
      {"mass of vertex 7", [](auto& g) { g.masses[7] = INFINITY; }},
      {"weight is not finite", [](auto& g) { g.weights[0] = NAN; }},
      {"another weight", [](auto& g) { g.weights[0] *= 1.001; }},
      {"logarithm is not finite", [](auto& g) { g.logs[3] = NAN, g.mean_edge_length = 1.0; }},
      {"not orthogonal", [](auto& g) { g.transports[0] *= 1.01; }},
      {"not inverse", [](auto& g) { std::swap(g.transports[0], g.transports[1]); }},
      {"self loops", [](auto& g) { g.neighbors[0] = 0; }},
      {"edge 0 -> 79", [](auto& g) { g.neighbors[0] = 79; }},
      {"outside [0, 80)", [](auto& g) { g.neighbors[0] = 80; }},
      {"edge ", [](auto& g) { g.neighbors.back() = g.neighbors[g.row_begin[79]]; }},  // an edge without its reverse
      {"mean edge length", [](auto& g) { g.mean_edge_length = 0.0; }},
      {"unit of length", [](auto& g) { g.length_unit = 0.0; }},
      {"unit of length", [](auto& g) { g.length_unit = -1.0; }},
      {"unit of length", [](auto& g) { g.length_unit = INFINITY; }},
      {"unit of length", [](auto& g) { g.length_unit = NAN; }},
      {"'weights' has length", [](auto& g) { g.weights.pop_back(); }},
      {"row_begin", [](auto& g) { g.row_begin[3] = 100000; }},
      {"no vertices", [](auto& g) { g = {.row_begin = {0}}; }},
      {"dimension 2",
       [](auto& g) { g = line_graph(4).data, g.kind = TransportKind::rotation2, g.transports.resize(12); }},
  };
  for (const auto& [law, break_law] : cases) {
    CsrGraphData g = sphere_graph(80);
    break_law(g);
    expect_error<InvalidGraph>([&] { validate(CsrGraph(g)); }, law);
  }
}

TEST(Validate, RefusesStarsOfAnotherDimension) {
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

}  // namespace
}  // namespace ahm::test
