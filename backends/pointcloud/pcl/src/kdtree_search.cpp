#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ahm/pcl/search.hpp"
#include "float_cloud.hpp"

namespace ahm::pcl_bridge {
namespace {

double squared_distance(const Vec3& a, const Vec3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

class KdTreeSearch final : public pointcloud::NeighborSearch {
 public:
  explicit KdTreeSearch(std::span<const Vec3> points)
      : points_(points), float_cloud_(to_float_cloud(points, "kdtree_search")) {
    if (!points.empty()) tree_.setInputCloud(float_cloud_.cloud);
  }

  Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const override {
    const std::size_t wanted = std::min(indices.size(), points_.size());
    if (wanted == 0) return 0;
    // A few more than asked for, because rounding to single precision may swap neighbours around the last place.
    constexpr std::size_t spare = 4;
    ::pcl::Indices found;
    std::vector<float> ignored;
    tree_.nearestKSearch(float_cloud_.convert(query), static_cast<unsigned>(std::min(wanted + spare, points_.size())),
                         found, ignored);
    std::vector<std::pair<double, Index>> sorted;
    sorted.reserve(found.size());
    for (const auto i : found) sorted.emplace_back(squared_distance(query, points_[i]), static_cast<Index>(i));
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < wanted; ++i) {
      squared_distances[i] = sorted[i].first;
      indices[i] = sorted[i].second;
    }
    return static_cast<Index>(wanted);
  }

 private:
  std::span<const Vec3> points_;
  FloatCloud float_cloud_;
  ::pcl::KdTreeFLANN<::pcl::PointXYZ> tree_;
};

}  // namespace

std::unique_ptr<pointcloud::NeighborSearch> kdtree_search(std::span<const Vec3> points) {
  return std::make_unique<KdTreeSearch>(points);
}

}  // namespace ahm::pcl_bridge
