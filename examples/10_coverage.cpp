// A path that covers a curved panel: a raster in log coordinates, mapped to points, normals and headings.
#include <ahm/applications/coverage.hpp>
#include <ahm/maps/log_map_solver.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  std::vector<ahm::Vec3> points;  // a panel rolled about the y axis, radius 0.5
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      points.push_back({0.5 * std::sin(0.02 * (i - 30)), 0.01 * (j - 30), 0.5 * std::cos(0.02 * (i - 30))});
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(points);
  const ahm::LogMapSolver solver(cloud.graph());
  const ahm::LogMap map =
      solver.solve(cloud.source(ahm::Row{30 * 60 + 30}, ahm::Vec3{1, 0, 0}).source, {.frames = true});

  const ahm::InverseMap inverse = ahm::inverse_map(cloud.graph(), map);
  if (const auto corner = inverse.at(0.1, 0.05))
    std::printf("(0.1, 0.05) lies at %.4f %.4f %.4f\n", corner->position[0], corner->position[1], corner->position[2]);

  const ahm::CoveragePath path = ahm::coverage_path(inverse, {.radius = 0.2, .spacing = 0.02});
  double length = 0, before = 0;
  for (const ahm::CoveragePoint& p : path.points) {
    if (p.arclength > before) length += p.arclength - before;
    before = p.arclength;  // starts at 0 in every piece
  }
  std::printf("%zu points in %d pieces, %.2f long\n", path.points.size(), static_cast<int>(path.pieces), length);
  return path.pieces >= 19 && static_cast<ahm::Offset>(path.points.size()) > path.planned * 95 / 100 ? 0 : 1;
}
