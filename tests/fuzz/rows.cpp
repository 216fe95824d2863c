// Graphs with arbitrary rows: errors, or valid graphs with maps.
#include "ahm/graph/csr_graph.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t flags = bytes.byte();
    const bool coarse = (flags & 1) == 0;
    CsrGraphData g;
    g.dimension = (flags & 2) == 0 ? 2 : 1 + bytes.byte() % 4;
    g.kind = (flags & 4) == 0 ? TransportKind::rotation2 : TransportKind::block;
    g.is_delaunay = (flags & 8) != 0;
    const auto fill = [&](std::vector<double>& array, std::size_t length) {
      array.resize(length);
      for (double& value : array) value = bytes.coordinate(coarse);
    };
    const std::size_t n = bytes.byte() % 12;
    g.row_begin = {0};
    for (std::size_t i = 0; i < n; ++i)
      g.row_begin.push_back((flags & 16) == 0 ? g.row_begin.back() + bytes.byte() % 5 : bytes.take<std::int8_t>());
    const auto edges = static_cast<std::size_t>(std::max<Offset>(0, g.row_begin.back()));
    g.neighbors.resize(edges);
    for (Index& neighbor : g.neighbors) neighbor = static_cast<Index>(bytes.take<std::int8_t>());
    fill(g.weights, edges);
    const auto d = static_cast<std::size_t>(g.dimension);
    fill(g.logs, edges * d);
    fill(g.transports, edges * (g.kind == TransportKind::rotation2 ? 2 : d * d));
    fill(g.masses, n);
    if ((flags & 32) != 0) fill(g.component_edge_lengths, bytes.byte() % 12);
    if ((flags & 64) != 0) g.mean_edge_length = bytes.coordinate(coarse);
    if ((flags & 128) != 0) g.length_unit = bytes.coordinate(coarse);
    const CsrGraph graph(std::move(g));
    validate(graph);
    fuzz::solve(graph, bytes);
  });
}
