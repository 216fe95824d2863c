#include <pcl/features/normal_3d_omp.h>

#include <algorithm>
#include <string>

#include "ahm/error.hpp"
#include "ahm/pcl/filters.hpp"
#include "ahm/util/text.hpp"
#include "float_cloud.hpp"

namespace ahm::pcl_bridge {

std::vector<Vec3> estimate_normals(std::span<const Vec3> points, int k, unsigned threads) {
  if (k < 3) throw InvalidArgument("estimate_normals: k is " + std::to_string(k) + ", must be at least 3");
  if (points.size() < 3)
    throw InvalidArgument("estimate_normals: points has " + detail::counted(points.size(), "element") +
                          ", needs at least 3");
  const FloatCloud input = to_float_cloud(points, "estimate_normals");
  ::pcl::NormalEstimationOMP<::pcl::PointXYZ, ::pcl::Normal> estimation(threads);
  estimation.setInputCloud(input.cloud);
  estimation.setKSearch(static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(k), points.size())));
  ::pcl::PointCloud<::pcl::Normal> output;
  estimation.compute(output);
  std::vector<Vec3> normals;
  normals.reserve(output.size());
  for (const auto& n : output) normals.push_back({n.normal_x, n.normal_y, n.normal_z});
  return normals;
}

}  // namespace ahm::pcl_bridge
