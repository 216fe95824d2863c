// The least program on top of libahm: the log map of a flat grid of points.
#include <ahm/ahm.hpp>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> points;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) points.push_back({0.1 * x, 0.1 * y, 0});
  const ahm::SurfaceSolver solver(ahm::pointcloud::PointCloudSurface::build(points));
  const ahm::SurfaceLogMap map = solver.log_map(0);
  std::printf("distance to the far corner: %.15g\n", map.distance.back());
  return std::abs(map.distance.back() - 1.9 * std::sqrt(2.0)) < 1e-11 ? 0 : 1;
}
