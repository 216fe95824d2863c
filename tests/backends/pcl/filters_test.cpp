#include "ahm/pcl/filters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ahm/error.hpp"
#include "clouds.hpp"

namespace ahm::pcl_bridge {
namespace {

using test::flat_square;
using test::random_box;
using test::squared_distance;

TEST(VoxelGrid, RepresentsEveryVoxelByOneOfItsPoints) {
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
    EXPECT_LE(largest(points[i] - reduced.points[row]), size * (1 + 1e-5));  // in one box, up to single precision
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
  std::map<Index, std::vector<Vec3>> members;
  for (std::size_t i = 0; i < points.size(); ++i) members[reduced.row_of_point[i]].push_back(points[i]);
  for (const auto& [row, list] : members) {
    Vec3 centroid{};
    for (const Vec3& p : list) centroid = centroid + 1.0 / static_cast<double>(list.size()) * p;
    double best = INFINITY;
    for (const Vec3& p : list) best = std::min(best, norm(p - centroid));
    EXPECT_NEAR(norm(reduced.points[row] - centroid), best, 1e-6);
  }
}

TEST(VoxelGrid, KeepsPointsFartherApartThanAVoxelAndTheirNormals) {
  const auto square = flat_square(20);
  EXPECT_EQ(voxel_grid(square, {}, 0.02).points, square);
  const auto points = random_box(300);
  const ReducedCloud reduced = voxel_grid(points, points, 0.3);
  EXPECT_EQ(reduced.normals, reduced.points);
}

TEST(VoxelGrid, ReducesTheSmallestClouds) {
  EXPECT_TRUE(voxel_grid({}, {}, 1.0).points.empty());
  const std::vector<Vec3> one = {{4, 5, 6}}, equal(50, Vec3{1, 1, 1});
  for (double size : {1e-300, 1e-9, 1.0, 1e300}) EXPECT_EQ(voxel_grid(one, {}, size).points, one) << size;
  EXPECT_EQ(voxel_grid(equal, {}, 0.5).point_of_row, std::vector<Index>{0});
}

TEST(OutlierRemoval, RemovesDistantPointsAndKeepsTheOrder) {
  auto points = flat_square(40);
  points.insert(points.begin(), {0.5, 0.5, 3.0});
  points.insert(points.begin() + 700, {-2.0, 0.5, 0.0});
  points.insert(points.begin() + 1601, {0.5, 4.0, 1.0});
  std::vector<Index> expected;
  for (Index i = 0; i < 1603; ++i)
    if (i != 0 && i != 700 && i != 1601) expected.push_back(i);
  EXPECT_EQ(outlier_removal(points), expected);
}

TEST(OutlierRemoval, NeedsNoMoreNeighborsThanThereAre) {
  EXPECT_EQ(outlier_removal(random_box(5), 100, 10.0).size(), 5U);
  EXPECT_EQ(outlier_removal(random_box(2)).size(), 2U);
  EXPECT_TRUE(outlier_removal({}).empty());
}

TEST(EstimateNormals, FindsTheNormalOfAPlane) {
  for (const Vec3& n : estimate_normals(flat_square(20), 12)) {
    EXPECT_NEAR(n[0], 0.0, 1e-6);
    EXPECT_NEAR(n[1], 0.0, 1e-6);
    EXPECT_NEAR(std::abs(n[2]), 1.0, 1e-6);
  }
}

TEST(Filters, RefuseBadParameters) {
  const auto points = random_box(100), wide = random_box(100, {0, 0, 0}, 1000.0);
  for (double size : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_THROW(voxel_grid(points, {}, size), InvalidArgument) << size;
  EXPECT_THROW(voxel_grid(points, std::vector<Vec3>(3), 0.1), InvalidArgument);
  for (double size : {0.1, 1e-12, 0x1p-1074})  // the number of voxels overflows
    EXPECT_THROW(voxel_grid(wide, {}, size), InvalidArgument) << size;
  EXPECT_NO_THROW(voxel_grid(wide, {}, 1.0));
  EXPECT_THROW(voxel_grid(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, {}, 1e-8), InvalidArgument);
  EXPECT_THROW(outlier_removal(points, 0), InvalidArgument);
  EXPECT_THROW(outlier_removal(points, 16, -1.0), InvalidArgument);
  EXPECT_THROW(outlier_removal(points, 16, NAN), InvalidArgument);
  EXPECT_THROW(estimate_normals(points, 2), InvalidArgument);
  EXPECT_THROW(estimate_normals(random_box(2), 10), InvalidArgument);
}

}  // namespace
}  // namespace ahm::pcl_bridge
