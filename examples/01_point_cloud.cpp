// From scattered points to the direction and distance of each of them, seen from one.
#include <ahm/maps/log_map_solver.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <cmath>
#include <cstdio>

int main() {
  // A rolled-up sheet: 100 x 100 points of the unit square on a cylinder of radius 0.3.
  std::vector<ahm::Vec3> points;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) {
      const double u = i / 99.0, angle = j / 99.0 / 0.3;
      points.push_back({u, 0.3 * std::sin(angle), 0.3 * std::cos(angle)});
    }

  const auto cloud = ahm::pointcloud::PointCloudSurface::build(points);
  const ahm::LogMapSolver solver(cloud.graph());  // factors once, then serves any number of sources
  const auto map =
      cloud.on_rows(solver.solve(cloud.source(ahm::Row{0}, ahm::Vec3{1, 0, 0}).source));  // u along the cylinder's axis

  // Unrolled, the last point is the far corner of the unit square.
  std::printf("u = %.4f  v = %.4f  distance = %.4f\n", map.u.back(), map.v.back(), map.distance.back());
}
