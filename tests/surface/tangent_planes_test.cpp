// Points and paths on the tangent planes of a cloud.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ahm/conformance/clouds.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {
namespace {

// The tangent planes of a cloud end with it: else a point far off would be a point far off on one of them.
TEST(Surface, TheClosestPointOfACloudIsNearOne) {
  const Cloud sphere = even_sphere(800);
  const auto cloud = pointcloud::PointCloudSurface::build(sphere.points);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double far : {1.0, 1.3, 30.0, 1e6})
    for (int trial = 0; trial < 20; ++trial) {
      Vec3 query{normal(random), normal(random), normal(random)};
      const double size = distance(query, {0, 0, 0});
      for (double& x : query) x *= far / size;
      const ClosestPoint found = cloud.closest_point(query);
      EXPECT_NEAR(distance(found.position, query), found.distance, 1e-9 * far);
      EXPECT_LT(distance(cloud.position(found.point), found.position), 1e-12);
      EXPECT_NEAR(distance(found.position, {0, 0, 0}), 1, 0.02);
    }
}

TEST(Surface, PathsOfACloudBeginAndEndAtItsPoints) {
  const Cloud sphere = random_sphere(3000);
  const auto cloud = pointcloud::PointCloudSurface::build(sphere.points);
  for (const Index end : {700, 1500, 2900}) {
    const SurfacePath line = shortest_line(cloud, Row(5), Row(end));
    EXPECT_EQ(line.points.front(), sphere.points[5]);
    EXPECT_EQ(line.points.back(), sphere.points[end]);
  }
}

}  // namespace
}  // namespace ahm::test
