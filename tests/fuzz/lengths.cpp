// Triangle meshes of edge lengths.
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t way = bytes.byte();
    const auto vertices = static_cast<Index>(bytes.byte() % 40);
    std::vector<Triangle> faces(bytes.byte() % 80);
    std::vector<std::array<double, 3>> lengths(faces.size());
    const Index most = vertices - ((way & 2) == 0 && vertices > 0 ? 1 : 0);
    // With the lengths of vertices' own numbers, so that faces agree on their edges; or of anything.
    std::vector<double> size_of(static_cast<std::size_t>(vertices) + 1);
    for (double& s : size_of) s = bytes.coordinate((way & 1) == 0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      faces[f] = {bytes.number(most), bytes.number(most), bytes.number(most)};
      for (std::size_t k = 0; k < 3; ++k)
        lengths[f][k] = (way & 32) == 0 ? 1 + std::abs(size_of[faces[f][k]] - size_of[faces[f][(k + 1) % 3]])
                                        : bytes.coordinate((way & 1) == 0);
    }
    const NonManifold how = (way & 4) == 0 ? NonManifold::split : NonManifold::error;
    trimesh::MeshOptions options{.threads = 1};
    options.intrinsic_delaunay = (way & 8) == 0;
    options.clamp_weights = (way & 16) == 0;
    const auto surface = trimesh::TriangleMeshSurface::build(
        trimesh::TriangleMesh::from_edge_lengths(vertices, faces, lengths, how), options);
    validate(surface.graph());
    fuzz::solve(surface.graph(), bytes);
  });
}
