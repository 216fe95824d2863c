// Many sources on one factorization, local by a radius, with progress and a way to stop.
#include <ahm/maps/log_map_solver.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> sphere;
  const int n = 5000;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z), turn = 2.399963 * i;
    sphere.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(sphere);
  const ahm::LogMapSolver solver(cloud.graph());

  std::vector<ahm::Source> sources;
  for (int point = 0; point < n; point += 100) sources.push_back(cloud.source(ahm::Row{point}).source);

  std::stop_source stop;  // stop.request_stop() from anywhere makes solve throw ahm::Cancelled
  ahm::MapOptions options;
  options.radius = 0.5;
  options.progress = {[](std::string_view stage, double done) {
                        std::printf("%.*s %3.0f %%\n", static_cast<int>(stage.size()), stage.data(), 100 * done);
                      },
                      stop.get_token()};
  const std::vector<ahm::LogMap> maps = solver.solve(sources, options);

  ahm::Index covered = 0;
  for (const ahm::LogMap& map : maps) covered += map.count(ahm::Status::ok);
  std::printf("%zu maps of %.0f points each\n", maps.size(),
              static_cast<double>(covered) / static_cast<double>(maps.size()));
}
