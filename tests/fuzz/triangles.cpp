// Triangle meshes with positions: few vertices, arbitrary faces.
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t flags = bytes.byte();
    const std::vector<Vec3> positions = bytes.points(bytes.byte() % 40, (flags & 1) == 0);
    const auto faces = bytes.triangles(bytes.byte() % 80, fuzz::largest_corner(positions.size(), flags));
    const auto surface =
        trimesh::TriangleMeshSurface::build(positions, faces, fuzz::mesh_options<trimesh::MeshOptions>(flags));
    fuzz::check_surface(surface, bytes);
    const LogMapSolver solver(surface.graph(), {.threads = 1});
    const FacePoint point{bytes.number(static_cast<Index>(faces.size()) - 1), {0.25, 0.25, 0.5}};
    const LogMap map = solver.solve(surface.source(point).source);
    fuzz::check_map(map);
    (void)surface.to_rows(map);
    (void)surface.to_corners(map);
    (void)surface.at(map, FacePoint{bytes.number(static_cast<Index>(faces.size()) - 1), {0.5, 0, 0.5}});
  });
}
