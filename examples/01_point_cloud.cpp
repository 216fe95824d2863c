// Directions and distances of scattered points from one of them.
#include <ahm/ahm.hpp>
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

  const ahm::SurfaceSolver solver(ahm::pointcloud::PointCloudSurface::build(points));
  const ahm::SurfaceLogMap map = solver.log_map(0, {.u_axis = ahm::Vec3{1, 0, 0}});  // u along the axis of the cylinder

  // Unrolled, the last point is the far corner of the unit square.
  std::printf("u = %.4f  v = %.4f  distance = %.4f\n", map.u.back(), map.v.back(), map.distance.back());
  return std::abs(map.u.back() - 1) < 0.01 ? 0 : 1;
}
