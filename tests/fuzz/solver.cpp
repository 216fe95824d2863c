// The solver on valid graphs with arbitrary weights, parallel edges, reflections and several components.
#include <numbers>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/local_maps.hpp"
#include "maps.hpp"

namespace ahm::fuzz {
namespace {

struct Edge {
  Index from, to;
  double weight, length, direction, turn;
  bool mirrored;
};

std::vector<Edge> take_edges(Bytes& bytes, Index n, bool coarse, bool reflections) {
  std::vector<Edge> edges(static_cast<std::size_t>(bytes.byte() % 64));
  for (Edge& e : edges) {
    e.from = bytes.number(n - 1), e.to = bytes.number(n - 1);
    e.weight = bytes.coordinate(coarse), e.length = bytes.coordinate(coarse);
    e.direction = bytes.byte() * std::numbers::pi / 128, e.turn = bytes.byte() * std::numbers::pi / 128;
    e.mirrored = reflections && bytes.byte() % 2 == 1;
  }
  std::erase_if(edges, [](const Edge& e) {
    return e.from == e.to || !std::isfinite(e.weight) || !(std::abs(e.length) < 1e100) || e.length == 0;
  });
  return edges;
}

/// Adds an edge to the row of its first (`forward`) or second vertex. R_ij maps vectors in the frame of j to the frame of i.
void add(CsrGraphData& g, const Edge& e, bool forward) {
  const double c = std::cos(e.turn), s = std::sin(e.turn);
  g.neighbors.push_back(forward ? e.to : e.from);
  g.weights.push_back(e.weight);
  const double direction = forward ? e.direction : e.direction + 1;
  g.logs.insert(g.logs.end(), {e.length * std::cos(direction), e.length * std::sin(direction)});
  if (g.kind == TransportKind::rotation2)
    g.transports.insert(g.transports.end(), {c, forward ? s : -s});
  else if (e.mirrored)
    g.transports.insert(g.transports.end(), {c, s, s, -c});  // its own inverse
  else
    g.transports.insert(g.transports.end(), {c, forward ? -s : s, forward ? s : -s, c});
}

CsrGraph take_graph(Bytes& bytes) {
  const std::uint8_t flags = bytes.byte();
  const bool coarse = (flags & 1) == 0;
  CsrGraphData g;
  g.kind = (flags & 2) == 0 ? TransportKind::rotation2 : TransportKind::block;
  const auto n = static_cast<Index>(1 + bytes.byte() % 24);
  const std::vector<Edge> edges = take_edges(bytes, n, coarse, g.kind == TransportKind::block);
  g.row_begin = {0};
  for (Index i = 0; i < n; ++i) {
    for (const Edge& e : edges) {
      if (e.from == i) add(g, e, true);
      if (e.to == i) add(g, e, false);
    }
    g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
    const double mass = std::abs(bytes.coordinate(coarse));
    g.masses.push_back(mass > 0 && mass < 1e100 ? mass : 1);
  }
  return CsrGraph(std::move(g));
}

}  // namespace
}  // namespace ahm::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const CsrGraph graph = fuzz::take_graph(bytes);
    validate(graph);
    LocalMapOptions local;
    local.heat.threads = 1;
    local.radius = std::abs(bytes.coordinate(true));
    local.k = bytes.byte() % 8;
    fuzz::allow_refusals([&] { (void)local_maps(graph, local); });
    fuzz::solve(graph, bytes);
  });
}
