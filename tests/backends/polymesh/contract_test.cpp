// The published contract, on polygon meshes.
#include "ahm/conformance/graph_contract.hpp"
#include "polygon_graphs.hpp"

namespace ahm::test {
namespace {

std::unique_ptr<TangentGraph> graph_of(const Polygons& mesh, bool clamp = true) {
  const auto surface = build(mesh, {.clamp_weights = clamp});
  return std::make_unique<CsrGraph>(surface.graph().data());
}

struct QuadGraphs {
  static std::unique_ptr<TangentGraph> surface() { return graph_of(cube_sphere(6)); }
  static std::unique_ptr<TangentGraph> flat() { return graph_of(voronoi_square(150)); }
};

struct SignedGraphs {
  static constexpr bool signed_weights = true;
  static std::unique_ptr<TangentGraph> surface() { return graph_of(voronoi_sphere(120), false); }
  static std::unique_ptr<TangentGraph> flat() { return graph_of(l_shapes(8), false); }
};

struct MoebiusGraphs {
  static std::unique_ptr<TangentGraph> surface() { return graph_of(moebius_quads(40, 4)); }
  static std::unique_ptr<TangentGraph> flat() { return graph_of(brick_wall(9)); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Polygons, GraphContract, QuadGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(PolygonsAsPublished, GraphContract, SignedGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(MoebiusPolygons, GraphContract, MoebiusGraphs);

}  // namespace
}  // namespace ahm::test
