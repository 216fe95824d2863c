// Many maps within a radius from one solver, with progress and cancellation; then distances and a path.
#include <ahm/ahm.hpp>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> sphere;
  const int n = 5000;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z), turn = 2.399963 * i;
    sphere.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  const ahm::SurfaceSolver solver(ahm::pointcloud::PointCloudSurface::build(sphere));

  std::vector<ahm::Location> sources;
  for (int point = 0; point < n; point += 100) sources.emplace_back(point);

  std::stop_source stop;  // stop.request_stop() from any thread makes log_maps throw ahm::Cancelled
  const ahm::Progress progress{[](std::string_view stage, double done) {
                                 std::printf("%.*s %3.0f %%\n", static_cast<int>(stage.size()), stage.data(),
                                             100 * done);
                               },
                               stop.get_token()};
  const std::vector<ahm::SurfaceLogMap> maps =
      solver.log_maps(sources, {.radius = 0.5, .frames = false, .progress = progress});
  std::size_t mapped = 0;
  for (const ahm::SurfaceLogMap& map : maps)
    for (const ahm::Status status : map.status) mapped += status == ahm::Status::ok;
  std::printf("%zu maps of %zu points each\n", maps.size(), mapped / maps.size());

  const std::vector<double> distance = solver.distance({0, n - 1});  // from the nearer of the two poles
  const ahm::SurfacePath path = solver.path(0, n - 1);
  std::printf("the equator is %.3f away, the other pole %.3f\n", distance[n / 2], path.length);
  return std::abs(distance[n / 2] - std::acos(0.0)) < 0.05 ? 0 : 1;
}
