// Accuracy on the unit sphere against its closed form, averaged over eight sources: bench_sphere_accuracy [points ...]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "ahm/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_graph.hpp"
#include "clouds.hpp"

namespace {

using ahm::Vec3;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Errors {
  double rms = 0, hemisphere = 0, angle = 0;
};

/// Root mean square of the vector and angle errors over d <= 0.9 pi, largest vector error over the hemisphere.
Errors errors(const std::vector<Vec3>& points, const ahm::pointcloud::PointCloudGraph& cloud,
              const ahm::pointcloud::PointMap& map, ahm::Index source) {
  const ahm::Frame frame = *cloud.graph().frame(cloud.vertex_of_point()[source]);
  Errors result;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::acos(std::clamp(dot(points[i], points[source]), -1.0, 1.0));
    if (distance > 0.9 * std::numbers::pi || static_cast<ahm::Index>(i) == source) continue;
    const double x = dot(frame.x, points[i]), y = dot(frame.y, points[i]), r = std::hypot(x, y);
    const double u = x / r * distance, v = y / r * distance;
    const double error = std::hypot(map.u[i] - u, map.v[i] - v);
    result.rms += error * error;
    result.angle += std::pow(std::atan2(map.v[i] * u - map.u[i] * v, map.u[i] * u + map.v[i] * v), 2);
    if (distance < std::numbers::pi / 2) result.hemisphere = std::max(result.hemisphere, error);
    ++count;
  }
  return {std::sqrt(result.rms / count), result.hemisphere, std::sqrt(result.angle / count)};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<ahm::Index> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atoi(argv[a]));
  if (sizes.empty()) sizes = {10000, 40000, 160000};
  std::printf(
      "| points | sampling | t_coef | variant | rms | max, hemisphere | angle rms |\n|---|---|---|---|---|---|---|\n");
  for (ahm::Index n : sizes)
    for (std::string sampling : {"icosphere", "spiral", "random"}) {
      const auto points = sampling == "icosphere" ? ahm::bench::icosphere(n)
                          : sampling == "spiral"  ? ahm::bench::even_sphere(n)
                                                  : ahm::bench::random_sphere(n);
      const auto cloud = ahm::pointcloud::PointCloudGraph::build(points);
      for (double t_coef : {1.0, 4.0}) {
        const ahm::LogMapSolver solver(cloud.graph(), {.t_coef = t_coef});
        for (ahm::Variant variant : {ahm::Variant::adaptive, ahm::Variant::localized}) {
          Errors mean;
          for (ahm::Index s = 0; s < 8; ++s) {
            const ahm::Index source = 7 + s * static_cast<ahm::Index>(points.size() / 8);
            const auto map = cloud.on_points(solver.solve(cloud.source_at_point(source), {.variant = variant}));
            const Errors e = errors(points, cloud, map, source);
            mean.rms += e.rms / 8, mean.hemisphere += e.hemisphere / 8, mean.angle += e.angle / 8;
          }
          std::printf("| %zu | %s | %g | %s | %.4f | %.4f | %.4f |\n", points.size(), sampling.c_str(), t_coef,
                      std::string(ahm::to_string(variant)).c_str(), mean.rms, mean.hemisphere, mean.angle);
        }
      }
    }
}
