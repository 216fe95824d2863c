// The published contract, on triangle meshes.
#include "ahm/conformance/graph_contract.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"

namespace ahm::test {
namespace {

struct MeshGraphs {
  static std::unique_ptr<TangentGraph> make(const Mesh& mesh, bool flips = true) {
    const auto built = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.intrinsic_delaunay = flips});
    return std::make_unique<CsrGraph>(built.graph().data());
  }
  static std::unique_ptr<TangentGraph> surface() { return make(icosphere(5)); }
  static std::unique_ptr<TangentGraph> flat() { return make(sliver_square(400)); }
};

struct PlainMeshGraphs {
  static std::unique_ptr<TangentGraph> surface() { return MeshGraphs::make(icosphere(6), false); }
  static std::unique_ptr<TangentGraph> flat() { return MeshGraphs::make(holed_square(15), false); }
};

struct MoebiusGraphs {
  static std::unique_ptr<TangentGraph> surface() { return MeshGraphs::make(moebius_mesh(40, 4)); }
  static std::unique_ptr<TangentGraph> flat() { return MeshGraphs::make(folded_strip(12)); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Meshes, GraphContract, MeshGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(MeshesWithoutFlips, GraphContract, PlainMeshGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(MoebiusMeshes, GraphContract, MoebiusGraphs);

}  // namespace
}  // namespace ahm::test
