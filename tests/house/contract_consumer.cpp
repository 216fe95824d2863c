// A user's own graph under the published contract.
#include <ahm/conformance/curved_graphs.hpp>
#include <ahm/conformance/flat_graphs.hpp>
#include <ahm/conformance/graph_contract.hpp>
#include <ahm/graph/csr_graph.hpp>

namespace ahm::test {

struct MyGraphs {
  static std::unique_ptr<TangentGraph> surface() { return std::make_unique<CsrGraph>(sphere_graph(80)); }
  static std::unique_ptr<TangentGraph> flat() { return std::make_unique<CsrGraph>(planar_triangulation(9).data); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Mine, GraphContract, MyGraphs);

}  // namespace ahm::test
