// The part of a cloud around a point.
#include "ahm/pointcloud/surroundings.hpp"

#include <gtest/gtest.h>

#include "ahm/testing/clouds.hpp"
#include "ahm/testing/vectors.hpp"

namespace ahm::test {
namespace {

TEST(Surroundings, AreThePointsWithinTheRadiusInTheirOrder) {
  Cloud cloud = random_sphere(2000);
  cloud.points[7] = {NAN, 0, 0};
  const Vec3 center = cloud.points[40];
  const auto near = pointcloud::surroundings(cloud.points, cloud.normals, center, 0.5);
  std::size_t k = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto row = static_cast<Index>(i);
    if (!(norm(minus(cloud.points[i], center)) <= 0.5)) {
      ASSERT_EQ(near.place_of(row), -1);
      continue;
    }
    ASSERT_LT(k, near.index.size());
    ASSERT_EQ(near.index[k], row);
    ASSERT_EQ(near.place_of(row), static_cast<Index>(k));
    ASSERT_EQ(near.points[k], cloud.points[i]);
    ASSERT_EQ(near.normals[k], cloud.normals[i]);
    ++k;
  }
  EXPECT_EQ(k, near.points.size());
  EXPECT_GT(k, 50u);
  EXPECT_EQ(near.place_of(7), -1);
}

TEST(Surroundings, HaveNormalsOnlyWhereTheCloudHas) {
  const Cloud cloud = random_sphere(100);
  EXPECT_TRUE(pointcloud::surroundings(cloud.points, {}, cloud.points[0], 10).normals.empty());
  EXPECT_EQ(pointcloud::surroundings(cloud.points, {}, cloud.points[0], 10).points.size(), 100u);
}

}  // namespace
}  // namespace ahm::test
