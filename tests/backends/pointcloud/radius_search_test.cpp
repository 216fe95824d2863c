// The part of a cloud around a point.
#include <gtest/gtest.h>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/vectors.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"

namespace ahm::test {
namespace {

TEST(Surroundings, AreThePointsWithinTheRadiusInTheirOrder) {
  Cloud cloud = random_sphere(2000);
  cloud.points[7] = {NAN, 0, 0};
  const Vec3 center = cloud.points[40];
  std::vector<Row> near;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (norm(minus(cloud.points[i], center)) <= 0.5) near.emplace_back(static_cast<Index>(i));
  EXPECT_EQ(pointcloud::radius_search(cloud.points, center, 0.5), near);
  EXPECT_GT(near.size(), 50u);
}

TEST(Surroundings, OfAWideRadiusAreAllFinitePoints) {
  Cloud cloud = random_sphere(100);
  cloud.points[31][2] = INFINITY;
  EXPECT_EQ(pointcloud::radius_search(cloud.points, cloud.points[0], 10).size(), 99u);
}

}  // namespace
}  // namespace ahm::test
