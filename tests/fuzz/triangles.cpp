// Triangle meshes of positions and faces: few vertices, faces of any corners.
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t way = bytes.byte();
    std::vector<Vec3> positions(bytes.byte() % 40);
    for (Vec3& position : positions) position = bytes.point((way & 1) == 0);
    std::vector<Triangle> faces(bytes.byte() % 80);
    const auto most = static_cast<Index>(positions.size()) - ((way & 2) == 0 && !positions.empty() ? 1 : 0);
    for (Triangle& face : faces) face = {bytes.number(most), bytes.number(most), bytes.number(most)};
    trimesh::MeshOptions options{.threads = 1};
    options.non_manifold = (way & 4) == 0 ? NonManifold::split : NonManifold::error;
    options.intrinsic_delaunay = (way & 8) == 0;
    options.clamp_weights = (way & 16) == 0;
    const auto surface = trimesh::TriangleMeshSurface::build(positions, faces, options);
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
