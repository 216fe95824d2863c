// Polygon meshes: few vertices, arbitrary faces of up to 8 corners.
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t flags = bytes.byte();
    const std::vector<Vec3> positions = bytes.points(bytes.byte() % 40, (flags & 1) == 0);
    const Index largest = fuzz::largest_corner(positions.size(), flags);
    std::vector<Offset> begin{0};
    std::vector<Index> corners;
    for (int faces = bytes.byte() % 60; faces > 0; --faces) {
      for (int k = bytes.byte() % 9; k > 0; --k) corners.push_back(bytes.number(largest));
      begin.push_back(static_cast<Offset>(corners.size()));
    }
    auto options = fuzz::mesh_options<polymesh::PolygonOptions>(flags);
    options.discretization = std::array{polymesh::Discretization::automatic, polymesh::Discretization::polygons,
                                        polymesh::Discretization::refined}[(flags >> 5) % 3];
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
