// A meeting point: mean and median of points on a dome, with the u axis along its meridians.
#include <ahm/applications/mean.hpp>
#include <ahm/fields/distance.hpp>
#include <ahm/pointcloud/point_cloud_surface.hpp>
#include <ahm/surface/directions.hpp>
#include <array>
#include <cmath>
#include <cstdio>

int main() {
  std::vector<ahm::Vec3> dome;  // the upper half of the unit sphere
  const int n = 3000;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (i + 0.5) / n, r = std::sqrt(1 - z * z), turn = 2.399963 * i;
    dome.push_back({r * std::cos(turn), r * std::sin(turn), z});
  }
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(dome);
  const ahm::LogMapSolver solver(cloud.graph());
  const auto near = [&](ahm::Vec3 p) { return cloud.vertex(cloud.nearest_row(p)); };

  const std::array towns{near({0.8, 0, 0.6}), near({-0.4, 0.69, 0.6}), near({-0.4, -0.69, 0.6})};
  const ahm::Center mean = ahm::karcher_mean(solver, towns);
  const ahm::Center median = ahm::geometric_median(solver, towns, std::array{3.0, 1.0, 1.0});
  const ahm::Vec3 top = cloud.graph().frame(mean.vertex.index)->origin;
  std::printf("mean: vertex %d at height %.3f, rms distance %.3f, %d maps\n", static_cast<int>(mean.vertex.index),
              top[2], mean.spread, static_cast<int>(mean.maps));
  std::printf("median: the heaviest town, %d (%d)\n", static_cast<int>(median.vertex.index),
              static_cast<int>(towns[0].index));

  // The distance of each point from the mean, and the direction away from it.
  const ahm::DistanceField field = ahm::distance_and_gradient(solver, ahm::source_at(mean));
  std::printf("a town is %.3f away\n", field.distance.values[towns[1].index]);

  // The map from a town, with u uphill.
  const ahm::LogMap map = solver.solve(
      ahm::Source::at_vertex(towns[0], ahm::direction_in_frame(cloud.graph(), ahm::Vertex(towns[0]), {0, 0, 1})));
  const auto phi = map.coordinates(mean.vertex);
  std::printf("from the first town the mean lies %.3f uphill and %.3f aside\n", phi[0], phi[1]);
  return top[2] > 0.99 && median.vertex == towns[0] ? 0 : 1;
}
