// Graphs of any rows: they are refused by name, or they keep their laws and are solved.
#include "ahm/graph/csr_graph.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t way = bytes.byte();
    const bool coarse = (way & 1) == 0;
    CsrGraphData g;
    g.dimension = (way & 2) == 0 ? 2 : 1 + bytes.byte() % 4;
    g.kind = (way & 4) == 0 ? TransportKind::rotation2 : TransportKind::block;
    g.is_delaunay = (way & 8) != 0;
    const auto fill = [&](std::vector<double>& array, std::size_t length) {
      array.resize(length);
      for (double& value : array) value = bytes.coordinate(coarse);
    };
    const std::size_t n = bytes.byte() % 12;
    g.row_begin = {0};
    for (std::size_t i = 0; i < n; ++i)
      g.row_begin.push_back((way & 16) == 0 ? g.row_begin.back() + bytes.byte() % 5 : bytes.take<std::int8_t>());
    const auto edges = static_cast<std::size_t>(std::max<Offset>(0, g.row_begin.back()));
    g.neighbors.resize(edges);
    for (Index& neighbor : g.neighbors) neighbor = static_cast<Index>(bytes.take<std::int8_t>());
    fill(g.weights, edges);
    const auto d = static_cast<std::size_t>(g.dimension);
    fill(g.logs, edges * d);
    fill(g.transports, edges * (g.kind == TransportKind::rotation2 ? 2 : d * d));
    fill(g.masses, n);
    if ((way & 32) != 0) fill(g.component_edge_lengths, bytes.byte() % 12);
    if ((way & 64) != 0) g.mean_edge_length = bytes.coordinate(coarse);
    if ((way & 128) != 0) g.length_unit = bytes.coordinate(coarse);
    const CsrGraph graph(std::move(g));
    validate(graph);
    fuzz::solve(graph, bytes);
  });
}
