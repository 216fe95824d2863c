// The contract suite, which includes the paper's operator, on every kind of graph of the core.
#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/graph_contract.hpp"

namespace ahm::test {
namespace {

struct RotationGraphs {
  static std::unique_ptr<TangentGraph> surface() { return std::make_unique<CsrGraph>(sphere_graph(150)); }
  static std::unique_ptr<TangentGraph> flat() { return std::make_unique<CsrGraph>(planar_triangulation(12).data); }
};

struct BlockGraphs {
  static std::unique_ptr<TangentGraph> surface() { return std::make_unique<CsrGraph>(as_blocks(sphere_graph(150, 2))); }
  static std::unique_ptr<TangentGraph> flat() {
    return std::make_unique<CsrGraph>(planar_triangulation(12, TransportKind::block, true).data);
  }
};

struct SpatialGraphs {
  static std::unique_ptr<TangentGraph> surface() { return std::make_unique<CsrGraph>(bent_lattice(5)); }
  static std::unique_ptr<TangentGraph> flat() { return std::make_unique<CsrGraph>(lattice3(6).data); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Rotations, GraphContract, RotationGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(Blocks, GraphContract, BlockGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(Space, GraphContract, SpatialGraphs);

}  // namespace
}  // namespace ahm::test
