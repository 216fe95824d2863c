/// \file
/// Conversion from `pcl::PointCloud` to the arrays of the point cloud backend, and from a log map to `pcl::PointCloud`.
///
/// \code
/// auto scan = ahm::pcl_bridge::from_pcl(*cloud);                                       // any point type with x, y, z
/// auto cloud = ahm::pointcloud::PointCloudSurface::build(scan.points, scan.normals);
/// auto map = cloud.to_rows(ahm::LogMapSolver(cloud.graph()).solve(cloud.source(ahm::Row{0}).source));
/// pcl::PointCloud<ahm::pcl_bridge::PointLogMap> result = ahm::pcl_bridge::to_pcl(*cloud, map);
/// \endcode
///
/// Compile sources that include this header for the same processor as PCL. PCL packages of distributions crash in code built with
/// -march=native or -mavx, because Eigen then aligns memory differently.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/type_traits.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/pcl/point_types.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::pcl_bridge {

/// The arrays that `PointCloudSurface::build` takes.
struct CloudArrays {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;  ///< empty if the point type has no normals
};

/// Positions, and normals if the point type has them, in the order of the cloud. Keeps non-finite points; see
/// `CloudOptions::drop_non_finite`.
template <typename PointT>
CloudArrays from_pcl(const ::pcl::PointCloud<PointT>& cloud) {
  static_assert(::pcl::traits::has_xyz<PointT>::value, "the point type needs the fields x, y, z");
  CloudArrays result;
  result.points.reserve(cloud.size());
  for (const PointT& p : cloud) result.points.push_back({p.x, p.y, p.z});
  if constexpr (::pcl::traits::has_normal<PointT>::value) {
    result.normals.reserve(cloud.size());
    for (const PointT& p : cloud) result.normals.push_back({p.normal_x, p.normal_y, p.normal_z});
  }
  return result;
}

namespace detail {

inline PointLogMap log_map_point(float x, float y, float z, const RowLogMap& map, std::size_t i) {
  PointLogMap p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.data[3] = 1.0F;
  p.u = static_cast<float>(map.u[i]);
  p.v = static_cast<float>(map.v[i]);
  p.distance = static_cast<float>(map.distance[i]);
  p.angle = static_cast<float>(map.angle[i]);
  p.status = static_cast<std::uint32_t>(map.status[i]);
  return p;
}

inline bool all_ok(const RowLogMap& map) {
  return std::all_of(map.status.begin(), map.status.end(), [](Status s) { return s == Status::ok; });
}

inline void require_rows(std::size_t points, const RowLogMap& map) {
  for (std::size_t rows : {map.u.size(), map.v.size(), map.distance.size(), map.angle.size(), map.status.size()})
    if (rows != points)
      throw InvalidArgument("to_pcl: map has " + std::to_string(rows) + " rows for a cloud of " +
                            std::to_string(points) + " points; pass the cloud the map was made from");
}

}  // namespace detail

/// The log map on the points of its cloud, in the same order, with the same width and height.
/// @throws InvalidArgument (the map has another number of rows)
template <typename PointT>
::pcl::PointCloud<PointLogMap> to_pcl(const ::pcl::PointCloud<PointT>& cloud, const RowLogMap& map) {
  detail::require_rows(cloud.size(), map);
  ::pcl::PointCloud<PointLogMap> result;
  result.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    result.push_back(detail::log_map_point(cloud[i].x, cloud[i].y, cloud[i].z, map, i));
  result.header = cloud.header;
  result.width = cloud.width;
  result.height = cloud.height;
  result.is_dense = cloud.is_dense && detail::all_ok(map);
  result.sensor_origin_ = cloud.sensor_origin_;
  result.sensor_orientation_ = cloud.sensor_orientation_;
  return result;
}

/// The log map on the points of an array. Rounds positions to single precision.
/// @throws InvalidArgument (the map has another number of rows)
inline ::pcl::PointCloud<PointLogMap> to_pcl(std::span<const Vec3> points, const RowLogMap& map) {
  detail::require_rows(points.size(), map);
  ::pcl::PointCloud<PointLogMap> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    result.push_back(detail::log_map_point(static_cast<float>(points[i][0]), static_cast<float>(points[i][1]),
                                           static_cast<float>(points[i][2]), map, i));
  result.is_dense = detail::all_ok(map);
  return result;
}

}  // namespace ahm::pcl_bridge
