#include "ahm/pcl/convert.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <filesystem>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pcl/search.hpp"
#include "clouds.hpp"

namespace ahm::pcl_bridge {
namespace {

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

TEST(ToPcl, TakesAnArrayOfPoints) {
  const auto points = test::random_box(6);
  const auto cloud = to_pcl(points, make_map(6));
  ASSERT_EQ(cloud.size(), 6U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud[3].y, static_cast<float>(points[3][1]));
}

TEST(ToPcl, RefusesAMapOfAnotherCloud) {
  EXPECT_THROW(to_pcl(make_cloud<::pcl::PointXYZ>(), make_map(5)), InvalidArgument);
  EXPECT_THROW(to_pcl(test::random_box(3), make_map(5)), InvalidArgument);
}

TEST(ToPcl, StoresTheMapOfAScan) {
  ::pcl::PointCloud<::pcl::PointNormal> cloud;
  for (const Vec3& p : test::flat_square(30))
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

}  // namespace
}  // namespace ahm::pcl_bridge
