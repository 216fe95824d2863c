#include "ahm/pcl/filters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "ahm/error.hpp"
#include "clouds.hpp"

namespace ahm::pcl_bridge {
namespace {

using test::flat_square;
using test::random_box;
using test::squared_distance;

TEST(VoxelGrid, EveryVoxelHasOneRepresentativeOfItsOwn) {
  const auto points = random_box(5000, {10, -3, 2}, 1.0);
  const double size = 0.11;
  const ReducedCloud reduced = voxel_grid(points, {}, size);
  ASSERT_EQ(reduced.row_of_point.size(), points.size());
  ASSERT_EQ(reduced.points.size(), reduced.point_of_row.size());
  EXPECT_TRUE(std::is_sorted(reduced.point_of_row.begin(), reduced.point_of_row.end()));
  std::set<Index> used;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Index row = reduced.row_of_point[i];
    ASSERT_GE(row, 0);
    ASSERT_LT(static_cast<std::size_t>(row), reduced.points.size());
    used.insert(row);
    // Both lie in the same box, up to single precision.
    for (std::size_t a = 0; a < 3; ++a) EXPECT_LE(std::abs(points[i][a] - reduced.points[row][a]), size * (1 + 1e-5));
  }
  EXPECT_EQ(used.size(), reduced.points.size());
  for (std::size_t row = 0; row < reduced.points.size(); ++row) {
    EXPECT_EQ(reduced.points[row], points[reduced.point_of_row[row]]);
    EXPECT_EQ(reduced.row_of_point[reduced.point_of_row[row]], static_cast<Index>(row));
  }
}

TEST(VoxelGrid, RepresentativeIsTheMemberNearestToTheCentroid) {
  const auto points = random_box(2000);
  const ReducedCloud reduced = voxel_grid(points, {}, 0.2);
  std::map<Index, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < points.size(); ++i) members[reduced.row_of_point[i]].push_back(i);
  for (const auto& [row, list] : members) {
    Vec3 centroid{};
    for (std::size_t i : list)
      for (std::size_t a = 0; a < 3; ++a) centroid[a] += points[i][a] / static_cast<double>(list.size());
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i : list) best = std::min(best, squared_distance(points[i], centroid));
    EXPECT_NEAR(std::sqrt(squared_distance(reduced.points[row], centroid)), std::sqrt(best), 1e-6);
  }
}

TEST(VoxelGrid, KeepsEveryPointWhenVoxelsAreSmallerThanTheSpacing) {
  const auto points = flat_square(20);
  EXPECT_EQ(voxel_grid(points, {}, 0.02).points, points);
}

TEST(VoxelGrid, CarriesTheNormalOfTheRepresentative) {
  const auto points = random_box(300);
  const ReducedCloud reduced = voxel_grid(points, points, 0.3);
  EXPECT_EQ(reduced.normals, reduced.points);
}

TEST(VoxelGrid, RefusesVoxelsThatOverflow) {
  const auto points = random_box(100, {0, 0, 0}, 1000.0);
  EXPECT_THROW(voxel_grid(points, {}, 0.1), InvalidArgument);
  EXPECT_THROW(voxel_grid(points, {}, 1e-12), InvalidArgument);
  EXPECT_THROW(voxel_grid(points, {}, std::numeric_limits<double>::denorm_min()), InvalidArgument);
  EXPECT_NO_THROW(voxel_grid(points, {}, 1.0));
  const std::vector<Vec3> line = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_THROW(voxel_grid(line, {}, 1e-8), InvalidArgument);
}

TEST(VoxelGrid, RefusesSizesThatAreNoLength) {
  const auto points = random_box(10);
  for (double size : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(voxel_grid(points, {}, size), InvalidArgument) << size;
  EXPECT_THROW(voxel_grid(points, std::vector<Vec3>(3), 0.1), InvalidArgument);
}

TEST(VoxelGrid, HandlesTheSmallestClouds) {
  EXPECT_TRUE(voxel_grid({}, {}, 1.0).points.empty());
  const std::vector<Vec3> one = {{4, 5, 6}};
  for (double size : {1e-300, 1e-9, 1.0, 1e300}) EXPECT_EQ(voxel_grid(one, {}, size).points, one) << size;
  const std::vector<Vec3> equal(50, Vec3{1, 1, 1});
  EXPECT_EQ(voxel_grid(equal, {}, 0.5).point_of_row, std::vector<Index>{0});
}

TEST(OutlierRemoval, RemovesWhatLiesApartAndKeepsTheOrder) {
  auto points = flat_square(40);
  const std::vector<Index> strays = {0, 700, 1601};
  points.insert(points.begin(), {0.5, 0.5, 3.0});
  points.insert(points.begin() + 700, {-2.0, 0.5, 0.0});
  points.insert(points.begin() + 1601, {0.5, 4.0, 1.0});
  const std::vector<Index> kept = outlier_removal(points);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (Index stray : strays) EXPECT_FALSE(std::binary_search(kept.begin(), kept.end(), stray)) << stray;
  EXPECT_EQ(kept.size(), points.size() - strays.size());
}

TEST(OutlierRemoval, ClampsTheNeighboursToTheCloud) {
  EXPECT_EQ(outlier_removal(random_box(5), 100, 10.0).size(), 5U);
  EXPECT_EQ(outlier_removal(random_box(2)).size(), 2U);
  EXPECT_TRUE(outlier_removal({}).empty());
}

TEST(OutlierRemoval, RefusesBadParameters) {
  const auto points = random_box(50);
  EXPECT_THROW(outlier_removal(points, 0), InvalidArgument);
  EXPECT_THROW(outlier_removal(points, 16, -1.0), InvalidArgument);
  EXPECT_THROW(outlier_removal(points, 16, std::numeric_limits<double>::quiet_NaN()), InvalidArgument);
}

TEST(EstimateNormals, AreThoseOfThePlane) {
  for (const Vec3& n : estimate_normals(flat_square(20), 12)) {
    EXPECT_NEAR(n[0], 0.0, 1e-6);
    EXPECT_NEAR(n[1], 0.0, 1e-6);
    EXPECT_NEAR(std::abs(n[2]), 1.0, 1e-6);
  }
}

TEST(EstimateNormals, RefusesBadParameters) {
  EXPECT_THROW(estimate_normals(random_box(50), 2), InvalidArgument);
  EXPECT_THROW(estimate_normals(random_box(2), 10), InvalidArgument);
}

}  // namespace
}  // namespace ahm::pcl_bridge
