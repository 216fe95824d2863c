// The contract suite, which includes the paper's operator, on every kind of graph of the core.
#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/graph_contract.hpp"

namespace ahm::test {
namespace {

template <CsrGraphData (*make_surface)(), CsrGraphData (*make_flat)()>
struct Graphs {
  static std::unique_ptr<TangentGraph> surface() { return std::make_unique<CsrGraph>(make_surface()); }
  static std::unique_ptr<TangentGraph> flat() { return std::make_unique<CsrGraph>(make_flat()); }
};

using RotationGraphs = Graphs<[] { return sphere_graph(150); }, [] { return planar_triangulation(12).data; }>;
using BlockGraphs = Graphs<[] { return as_blocks(sphere_graph(150, 2)); },
                           [] { return planar_triangulation(12, TransportKind::block, true).data; }>;
using SpatialGraphs = Graphs<[] { return bent_lattice(5); }, [] { return lattice3(6).data; }>;

INSTANTIATE_TYPED_TEST_SUITE_P(Rotations, GraphContract, RotationGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(Blocks, GraphContract, BlockGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(Space, GraphContract, SpatialGraphs);

}  // namespace
}  // namespace ahm::test
