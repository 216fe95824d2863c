#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ahm/pcl/search.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
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
    // A few more than needed: single precision leaves the order of the last ones uncertain.
    std::vector<pointcloud::Candidate> found;
    for (std::size_t count = wanted + 4;; count *= 2) {
      const double reached = find(query, std::min(count, points_.size()), found);
      if (count >= points_.size() || count > max_factor * wanted) break;
      std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(wanted - 1), found.end());
      if (reached > std::sqrt(found[wanted - 1].first) + rounding * float_cloud_.unit) break;
    }
    pointcloud::take_nearest(found, wanted, indices, squared_distances);
    return static_cast<Index>(wanted);
  }

 private:
  static constexpr std::size_t max_factor = 8;
  static constexpr double rounding = 4e-7;  ///< error of distances in single precision, points of order one

  /// Finds the nearest points in single precision and stores their distances in double precision.
  /// @return distance of the farthest one in single precision
  double find(const Vec3& query, std::size_t count, std::vector<pointcloud::Candidate>& found) const {
    ::pcl::Indices indices;
    std::vector<float> squared;
    tree_.nearestKSearch(float_cloud_.convert(query), static_cast<unsigned>(count), indices, squared);
    found.clear();
    for (const auto i : indices) found.emplace_back(squared_distance(query, points_[i]), static_cast<Index>(i));
    return std::sqrt(static_cast<double>(squared.back())) * float_cloud_.unit;
  }

  std::span<const Vec3> points_;
  FloatCloud float_cloud_;
  ::pcl::KdTreeFLANN<::pcl::PointXYZ> tree_;
};

}  // namespace

std::unique_ptr<pointcloud::NeighborSearch> kdtree_search(std::span<const Vec3> points) {
  return std::make_unique<KdTreeSearch>(points);
}

}  // namespace ahm::pcl_bridge
