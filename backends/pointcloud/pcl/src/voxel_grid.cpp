#include <pcl/filters/voxel_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "ahm/error.hpp"
#include "ahm/pcl/filters.hpp"
#include "ahm/util/text.hpp"
#include "float_cloud.hpp"

namespace ahm::pcl_bridge {
namespace {

using Grid = ::pcl::VoxelGrid<::pcl::PointXYZ>;

std::string text(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

/// Rejects sizes that PCL does not support. PCL numbers voxels with 32-bit integers and returns the cloud unchanged on
/// overflow. It also rounds voxel coordinates to single precision, which fails for more than 2^23 voxels in a row.
void require_representable(const FloatCloud& input, double size) {
  double voxels = 1;
  double longest = 0;
  for (double extent : input.extent) {
    const double along = std::floor(extent * (input.unit / size)) + 2;  // + 2: voxels cut at both ends
    voxels *= along;
    longest = std::max(longest, along);
  }
  const double extent = *std::max_element(input.extent.begin(), input.extent.end()) * input.unit;
  if (!(voxels <= std::numeric_limits<std::int32_t>::max()) || !(longest <= 8388608.0))
    throw InvalidArgument("voxel_grid: size " + text(size) + " is too small for a cloud of extent " + text(extent) +
                          ": " + text(voxels) +
                          " voxels; PCL supports 2147483647, and 8388608 in a row; choose a larger size");
}

/// PCL's voxel number of each point, with the same arithmetic as pcl::VoxelGrid.
std::vector<unsigned> voxel_numbers(Grid& grid, const ::pcl::PointCloud<::pcl::PointXYZ>& cloud) {
  const Eigen::Vector3i low = grid.getMinBoxCoordinates();
  const Eigen::Vector3i step = grid.getDivisionMultiplier();
  std::vector<unsigned> numbers;
  numbers.reserve(cloud.size());
  for (const auto& p : cloud)
    numbers.push_back(static_cast<unsigned>((grid.getGridCoordinates(p.x, p.y, p.z) - low).dot(step)));
  return numbers;
}

/// For each voxel, in PCL's order, the point nearest to PCL's centroid; the first of equally near ones.
std::vector<Index> nearest_to_centroids(const ::pcl::PointCloud<::pcl::PointXYZ>& cloud,
                                        const ::pcl::PointCloud<::pcl::PointXYZ>& centroids,
                                        std::span<const Index> voxel_of_point) {
  std::vector<Index> nearest(centroids.size(), -1);
  std::vector<float> best(centroids.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto voxel = static_cast<std::size_t>(voxel_of_point[i]);
    const float d = (cloud[i].getVector3fMap() - centroids[voxel].getVector3fMap()).squaredNorm();
    if (d < best[voxel]) {
      best[voxel] = d;
      nearest[voxel] = static_cast<Index>(i);
    }
  }
  return nearest;
}

/// Rank of each voxel number among the distinct ones. PCL writes its centroids in this order.
std::vector<Index> ranks(const std::vector<unsigned>& numbers, std::size_t expected) {
  std::vector<unsigned> distinct = numbers;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.size() != expected)
    throw Error("voxel_grid: PCL returned " + detail::counted(expected, "voxel") + ", but " +
                std::to_string(distinct.size()) + " are occupied");
  std::vector<Index> result;
  result.reserve(numbers.size());
  for (unsigned n : numbers)
    result.push_back(static_cast<Index>(std::lower_bound(distinct.begin(), distinct.end(), n) - distinct.begin()));
  return result;
}

/// Collects the representative points in the order of the input.
ReducedCloud gather(std::span<const Vec3> points, std::span<const Vec3> normals,
                    const std::vector<Index>& voxel_of_point, const std::vector<Index>& point_of_voxel) {
  ReducedCloud result;
  std::vector<Index> row_of_voxel(point_of_voxel.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto voxel = static_cast<std::size_t>(voxel_of_point[i]);
    if (point_of_voxel[voxel] != static_cast<Index>(i)) continue;
    row_of_voxel[voxel] = static_cast<Index>(result.points.size());
    result.points.push_back(points[i]);
    if (!normals.empty()) result.normals.push_back(normals[i]);
    result.point_of_row.push_back(static_cast<Index>(i));
  }
  result.row_of_point.reserve(points.size());
  for (Index voxel : voxel_of_point) result.row_of_point.push_back(row_of_voxel[voxel]);
  return result;
}

}  // namespace

ReducedCloud voxel_grid(std::span<const Vec3> points, std::span<const Vec3> normals, double size) {
  if (!(size > 0) || !std::isfinite(size))
    throw InvalidArgument("voxel_grid: size is " + text(size) + ", must be finite and > 0");
  if (!normals.empty() && normals.size() != points.size())
    throw InvalidArgument("voxel_grid: normals has " + detail::counted(normals.size(), "element") + " for " +
                          detail::counted(points.size(), "point"));
  const FloatCloud input = to_float_cloud(points, "voxel_grid");
  if (points.empty()) return {};
  require_representable(input, size);
  // Limits the size to the range of single precision, for voxels much larger than the cloud and for clouds of one point. 8
  // units hold any cloud; sizes below 1e-7 were rejected above unless the extent is zero.
  const auto leaf = static_cast<float>(std::clamp(size / input.unit, 1e-7, 8.0));
  Grid grid;
  grid.setInputCloud(input.cloud);
  grid.setLeafSize(leaf, leaf, leaf);
  ::pcl::PointCloud<::pcl::PointXYZ> centroids;
  grid.filter(centroids);
  const std::vector<Index> voxel_of_point = ranks(voxel_numbers(grid, *input.cloud), centroids.size());
  return gather(points, normals, voxel_of_point, nearest_to_centroids(*input.cloud, centroids, voxel_of_point));
}

}  // namespace ahm::pcl_bridge
