// The least program on top of libahm: the log map of a flat grid of points.
#include <ahm/maps/log_map_solver.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> points;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) points.push_back({0.1 * x, 0.1 * y, 0});
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(points);
  const ahm::LogMapSolver solver(cloud.graph());
  const auto map = cloud.on_rows(solver.solve(cloud.source(ahm::Row{0}).source));
  std::printf("distance to the far corner: %.15g\n", map.distance.back());
  return std::abs(map.distance.back() - 1.9 * std::sqrt(2.0)) < 1e-11 ? 0 : 1;
}
