#include <pcl/filters/statistical_outlier_removal.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "ahm/error.hpp"
#include "ahm/pcl/filters.hpp"
#include "float_cloud.hpp"

namespace ahm::pcl_bridge {

std::vector<Index> outlier_removal(std::span<const Vec3> points, int mean_k, double stddev_mul) {
  if (mean_k < 1)
    throw InvalidArgument("outlier_removal: mean_k is " + std::to_string(mean_k) + ", must be at least 1");
  if (!std::isfinite(stddev_mul) || stddev_mul < 0)
    throw InvalidArgument("outlier_removal: stddev_mul is " + std::to_string(stddev_mul) + ", must be finite and >= 0");
  const FloatCloud input = to_float_cloud(points, "outlier_removal");
  std::vector<Index> kept(points.size());
  std::iota(kept.begin(), kept.end(), Index{0});
  if (points.size() < 3) return kept;  // too few for a standard deviation
  ::pcl::StatisticalOutlierRemoval<::pcl::PointXYZ> filter;
  filter.setInputCloud(input.cloud);
  // PCL reads past its arrays if the cloud has fewer than `mean_k` neighbors.
  filter.setMeanK(static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(mean_k), points.size() - 1)));
  filter.setStddevMulThresh(stddev_mul);
  ::pcl::Indices indices;
  filter.filter(indices);
  kept.assign(indices.begin(), indices.end());
  return kept;
}

}  // namespace ahm::pcl_bridge
