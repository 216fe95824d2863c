#include "ahm/pcl/convert.hpp"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pcl/search.hpp"
#include "clouds.hpp"

namespace ahm::pcl_bridge {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <typename PointT>
::pcl::PointCloud<PointT> make_cloud() {
  ::pcl::PointCloud<PointT> cloud(4, 2);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud[i].x = static_cast<float>(i);
    cloud[i].y = 0.5F * static_cast<float>(i);
    cloud[i].z = -static_cast<float>(i);
  }
  return cloud;
}

RowLogMap make_map(std::size_t n) {
  RowLogMap map;
  for (std::size_t i = 0; i < n; ++i) {
    map.u.push_back(static_cast<double>(i));
    map.v.push_back(0.25);
    map.distance.push_back(std::hypot(map.u[i], map.v[i]));
    map.angle.push_back(std::atan2(map.v[i], map.u[i]));
    map.status.push_back(Status::ok);
  }
  map.u[n - 1] = map.v[n - 1] = map.distance[n - 1] = map.angle[n - 1] = nan;
  map.status[n - 1] = Status::unreached;
  return map;
}

template <typename PointT>
class Convert : public testing::Test {};
using PointTypes = testing::Types<::pcl::PointXYZ, ::pcl::PointNormal, ::pcl::PointXYZRGB>;
TYPED_TEST_SUITE(Convert, PointTypes);

TYPED_TEST(Convert, KeepsPositionsOrderAndShapeThereAndBack) {
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
    EXPECT_EQ(arrays.points[i], (Vec3{cloud[i].x, cloud[i].y, cloud[i].z}));
    EXPECT_EQ(back[i].x, cloud[i].x);
    EXPECT_EQ(back[i].y, cloud[i].y);
    EXPECT_EQ(back[i].z, cloud[i].z);
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
  const CloudArrays arrays = from_pcl(with);
  ASSERT_EQ(arrays.normals.size(), with.size());
  for (const Vec3& n : arrays.normals) EXPECT_EQ(n, (Vec3{0, 0, 1}));
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

TEST(ToPcl, ClosesTheWayFromAScanToItsMap) {
  ::pcl::PointCloud<::pcl::PointNormal> cloud;
  for (const Vec3& p : test::flat_square(30)) {
    ::pcl::PointNormal point;
    point.x = static_cast<float>(p[0]);
    point.y = static_cast<float>(p[1]);
    point.normal_z = 1.0F;
    cloud.push_back(point);
  }
  const CloudArrays scan = from_pcl(cloud);
  pointcloud::CloudOptions options;
  options.search = kdtree_search;
  const auto graph = pointcloud::PointCloudSurface::build(scan.points, scan.normals, options);
  const LogMapSolver solver(graph.graph());
  const auto map = graph.to_rows(solver.solve(graph.source(Row(0), Vec3{1, 0, 0}).source));
  for (const PointLogMap& p : to_pcl(cloud, map)) {
    EXPECT_EQ(p.status, static_cast<std::uint32_t>(Status::ok));
    EXPECT_NEAR(p.u, p.x - cloud[0].x, 1e-6);
    EXPECT_NEAR(p.v, p.y - cloud[0].y, 1e-6);
  }
}

TEST(PointLogMap, SurvivesAPcdFile) {
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
