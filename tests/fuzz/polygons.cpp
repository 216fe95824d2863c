// Polygon meshes: few vertices, faces of any corners and any number of them.
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t way = bytes.byte();
    std::vector<Vec3> positions(bytes.byte() % 40);
    for (Vec3& position : positions) position = bytes.point((way & 1) == 0);
    const auto most = static_cast<Index>(positions.size()) - ((way & 2) == 0 && !positions.empty() ? 1 : 0);
    std::vector<Offset> begin{0};
    std::vector<Index> corners;
    for (int faces = bytes.byte() % 60; faces > 0; --faces) {
      for (int k = bytes.byte() % 9; k > 0; --k) corners.push_back(bytes.number(most));
      begin.push_back(static_cast<Offset>(corners.size()));
    }
    polymesh::PolygonOptions options{.threads = 1};
    options.non_manifold = (way & 4) == 0 ? NonManifold::split : NonManifold::error;
    options.intrinsic_delaunay = (way & 8) == 0;
    options.clamp_weights = (way & 16) == 0;
    options.discretization = std::array{polymesh::Discretization::automatic, polymesh::Discretization::polygons,
                                        polymesh::Discretization::refined}[(way >> 5) % 3];
    const auto surface = polymesh::PolygonMeshSurface::build(positions, begin, corners, options);
    fuzz::check_surface(surface, bytes);
    const LogMapSolver solver(surface.graph(), {.threads = 1});
    const Row row(bytes.number(static_cast<Index>(positions.size()) - 1));
    const LogMap map = solver.solve(surface.source(row).source);
    fuzz::check_map(map);
    (void)surface.to_rows(map);
    (void)surface.to_corners(map);
  });
}
