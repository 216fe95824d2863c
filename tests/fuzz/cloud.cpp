// Point clouds, with and without normals.
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ahm;
  return fuzz::allow_refusals([&] {
    fuzz::Bytes bytes(data, size);
    const std::uint8_t flags = bytes.byte();
    const bool coarse = (flags & 1) == 0;
    const std::vector<Vec3> points = bytes.points(bytes.byte(), coarse),
                            normals = bytes.points((flags & 2) == 0 ? 0 : points.size(), coarse);
    pointcloud::CloudOptions options{.threads = 1};
    if ((flags & 4) != 0) options.k = bytes.number(40);
    options.normal_signs = std::array{pointcloud::NormalSigns::automatic, pointcloud::NormalSigns::oriented,
                                      pointcloud::NormalSigns::unoriented}[(flags >> 3) % 3];
    options.drop_non_finite = (flags & 32) == 0;
    const auto surface = pointcloud::PointCloudSurface::build(points, normals, options);
    fuzz::check_surface(surface, bytes);
    const LogMapSolver solver(surface.graph(), {.threads = 1});
    const Row row(bytes.number(static_cast<Index>(points.size()) - 1));
    (void)surface.to_rows(solver.solve(surface.source(row).source));
  });
}
