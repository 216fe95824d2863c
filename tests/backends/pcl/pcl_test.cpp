// Conversions, filters and the neighbor search of PCL.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pcl/convert.hpp"
#include "ahm/pcl/filters.hpp"
#include "ahm/pcl/search.hpp"
#include "ahm/util/vec.hpp"
#include "backends/neighbor_search_laws.hpp"
#include "support/expect_error.hpp"

namespace ahm::pcl_bridge {
namespace {

using namespace test;

/// n points uniform in a box around `center`.
std::vector<Vec3> random_box(std::size_t n, const Vec3& center = {0, 0, 0}, double size = 1.0, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.5 * size, 0.5 * size);
  std::vector<Vec3> points(n);
  for (Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) p[a] = center[a] + uniform(generator);
  return points;
}

/// m x m points on the square [0, 1]^2 at height 0.
std::vector<Vec3> flat_square(int m) {
  std::vector<Vec3> points;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) points.push_back({i / (m - 1.0), j / (m - 1.0), 0.0});
  return points;
}

template <typename PointT>
::pcl::PointCloud<PointT> make_cloud() {
  ::pcl::PointCloud<PointT> cloud(4, 2);
  float x = 0;
  for (PointT& p : cloud) p.x = x, p.y = 0.5F * x, p.z = -x, ++x;
  return cloud;
}

/// A map whose last row is not reached.
RowLogMap make_map(std::size_t n) {
  RowLogMap map;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = i + 1 < n ? static_cast<double>(i) : NAN;
    map.u.push_back(u);
    map.v.push_back(0.25 + 0 * u);
    map.distance.push_back(std::sqrt(u * u + map.v[i] * map.v[i]));
    map.angle.push_back(std::atan2(map.v[i], u));
    map.status.push_back(i + 1 < n ? Status::ok : Status::unreached);
  }
  return map;
}

template <typename PointT>
class Convert : public testing::Test {};
using PointTypes = testing::Types<::pcl::PointXYZ, ::pcl::PointNormal, ::pcl::PointXYZRGB>;
TYPED_TEST_SUITE(Convert, PointTypes);

TYPED_TEST(Convert, KeepsPositionsOrderAndShapeInBothDirections) {
  auto cloud = make_cloud<TypeParam>();
  cloud.header.frame_id = "scanner";
  const CloudArrays arrays = from_pcl(cloud);
  ASSERT_EQ(arrays.points.size(), cloud.size());
  const auto map = make_map(cloud.size());
  const auto back = to_pcl(cloud, map);
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_EQ(back.width, cloud.width);
  EXPECT_EQ(back.height, cloud.height);
  EXPECT_EQ(back.header.frame_id, "scanner");
  EXPECT_FALSE(back.is_dense);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 position{cloud[i].x, cloud[i].y, cloud[i].z};
    EXPECT_EQ(arrays.points[i], position);
    EXPECT_EQ((Vec3{back[i].x, back[i].y, back[i].z}), position);
    EXPECT_EQ(back[i].status, static_cast<std::uint32_t>(map.status[i]));
    if (map.status[i] != Status::ok) continue;
    EXPECT_EQ(back[i].u, static_cast<float>(map.u[i]));
    EXPECT_EQ(back[i].v, static_cast<float>(map.v[i]));
    EXPECT_EQ(back[i].distance, static_cast<float>(map.distance[i]));
    EXPECT_EQ(back[i].angle, static_cast<float>(map.angle[i]));
  }
  EXPECT_TRUE(std::isnan(back.back().u));
}

TEST(FromPcl, TakesNormalsOnlyFromTypesThatHaveThem) {
  auto with = make_cloud<::pcl::PointNormal>();
  for (auto& p : with) p.normal_z = 1.0F;
  EXPECT_EQ(from_pcl(with).normals, std::vector<Vec3>(with.size(), Vec3{0, 0, 1}));
  EXPECT_TRUE(from_pcl(make_cloud<::pcl::PointXYZ>()).normals.empty());
  EXPECT_TRUE(from_pcl(make_cloud<::pcl::PointXYZRGB>()).normals.empty());
}

TEST(ToPcl, TakesAnArrayOfPointsButNoMapOfAnotherCloud) {
  const auto points = random_box(6);
  const auto cloud = to_pcl(points, make_map(6));
  ASSERT_EQ(cloud.size(), 6U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud[3].y, static_cast<float>(points[3][1]));
  EXPECT_THROW(to_pcl(points, make_map(5)), InvalidArgument);
  EXPECT_THROW(to_pcl(make_cloud<::pcl::PointXYZ>(), make_map(5)), InvalidArgument);
}

TEST(ToPcl, StoresTheMapOfAScan) {
  ::pcl::PointCloud<::pcl::PointNormal> cloud;
  for (const Vec3& p : flat_square(30))
    cloud.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), 0.0F, 0.0F, 0.0F, 1.0F});
  const CloudArrays scan = from_pcl(cloud);
  const auto surface = pointcloud::PointCloudSurface::build(scan.points, scan.normals, {.search = kdtree_search});
  const LogMapSolver solver(surface.graph());
  const auto map = surface.to_rows(solver.solve(surface.source(Row(0), Vec3{1, 0, 0}).source));
  for (const PointLogMap& p : to_pcl(cloud, map)) {
    EXPECT_EQ(p.status, static_cast<std::uint32_t>(Status::ok));
    EXPECT_NEAR(p.u, p.x - cloud[0].x, 1e-6);
    EXPECT_NEAR(p.v, p.y - cloud[0].y, 1e-6);
  }
}

TEST(PointLogMap, IsStoredInPcdFiles) {
  const auto cloud = to_pcl(make_cloud<::pcl::PointXYZ>(), make_map(8));
  const auto path = std::filesystem::path(testing::TempDir()) / "ahm_point_log_map.pcd";
  ASSERT_EQ(::pcl::io::savePCDFileBinary(path.string(), cloud), 0);
  ::pcl::PointCloud<PointLogMap> back;
  ASSERT_EQ(::pcl::io::loadPCDFile(path.string(), back), 0);
  std::filesystem::remove(path);
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_EQ(back[5].u, cloud[5].u);
  EXPECT_EQ(back[5].z, cloud[5].z);
  EXPECT_EQ(back[7].status, static_cast<std::uint32_t>(Status::unreached));
}

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

TEST(KdTreeSearch, FindsWhatBruteForceFindsAnywhereAtEveryScale) {
  // Single precision, relative to the cloud, decides which point is the last one.
  expect_nearest(kdtree_search, random_box(3000), 30, 4e-7);
  expect_nearest(kdtree_search, random_box(2000, {5e5, 5.4e6, 1e3}, 10), 20, 4e-6);
  for (double size : {1e-100, 1e100}) expect_nearest(kdtree_search, random_box(1000, {0, 0, 0}, size), 10, 4e-7 * size);
  expect_nearest(kdtree_search, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, 10);
  expect_nearest(kdtree_search, std::vector<Vec3>(500, Vec3{1, 2, 3}), 5);
}

TEST(KdTreeSearch, PrefersLowNumbersOfEquallyNearPoints) { expect_low_numbers_first(kdtree_search, 0.1); }

TEST(KdTreeSearch, MayBeCalledFromManyThreads) {
  const auto points = random_box(2000);
  const auto search = kdtree_search(points);
  const auto all = [&] {
    std::vector<Index> result, index(8);
    std::vector<double> squared(8);
    for (const Vec3& p : points) {
      search->nearest(p, index, squared);
      result.insert(result.end(), index.begin(), index.end());
    }
    return result;
  };
  const auto expected = all();
  std::vector<std::vector<Index>> results(4);
  {
    std::vector<std::jthread> threads;
    for (auto& r : results) threads.emplace_back([&] { r = all(); });
  }
  for (const auto& r : results) EXPECT_EQ(r, expected);
}

TEST(KdTreeSearch, NamesTheNonFinitePoint) {
  auto points = random_box(10);
  points[7][1] = NAN;
  expect_error<InvalidGeometry>([&] { kdtree_search(points); }, "point 7");
}

TEST(Version, HasAPoint) { EXPECT_NE(version().find('.'), std::string::npos); }

}  // namespace
}  // namespace ahm::pcl_bridge
