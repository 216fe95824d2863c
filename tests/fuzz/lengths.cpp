// Triangle meshes with edge lengths.
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t flags = bytes.byte();
    const auto vertices = static_cast<Index>(bytes.byte() % 40);
    std::vector<Triangle> faces(bytes.byte() % 80);
    std::vector<std::array<double, 3>> lengths(faces.size());
    const Index largest = fuzz::largest_corner(static_cast<std::size_t>(vertices), flags);
    // Lengths from numbers of the vertices, so that faces agree on their edges; or any lengths.
    std::vector<double> number_of(static_cast<std::size_t>(vertices) + 1);
    for (double& number : number_of) number = bytes.coordinate((flags & 1) == 0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      faces[f] = bytes.triangles(1, largest).front();
      for (std::size_t k = 0; k < 3; ++k)
        lengths[f][k] = (flags & 32) == 0 ? 1 + std::abs(number_of[faces[f][k]] - number_of[faces[f][(k + 1) % 3]])
                                          : bytes.coordinate((flags & 1) == 0);
    }
    const auto options = fuzz::mesh_options<trimesh::MeshOptions>(flags);
    const auto surface = trimesh::TriangleMeshSurface::build(
        trimesh::TriangleMesh::from_edge_lengths(vertices, faces, lengths, options.non_manifold), options);
    validate(surface.graph());
    fuzz::solve(surface.graph(), bytes);
  });
}
