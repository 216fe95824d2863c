#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// Adapter of points for nanoflann.
struct Points {
  std::span<const Vec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t point, std::size_t axis) const { return points[point][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// The k nearest points, sorted by distance and then by index, so that the result does not depend on the tree.
class NearestPoints {
 public:
  using DistanceType = double;

  NearestPoints(std::span<Index> indices, std::span<double> distances) : indices_(indices), distances_(distances) {}
  std::size_t size() const { return count_; }
  bool full() const { return count_ == indices_.size(); }
  /// Search radius: slightly above the last distance, to find points at equal distances despite rounding of the tree's bounds.
  double worstDist() const {  // NOLINT(readability-identifier-naming): nanoflann's name
    return full() ? distances_[count_ - 1] * (1 + 1e-14) : std::numeric_limits<double>::infinity();
  }
  bool addPoint(double distance, std::uint32_t point) {  // NOLINT(readability-identifier-naming)
    const auto index = static_cast<Index>(point);
    std::size_t at = count_;
    const auto before = [&](std::size_t other) {
      return distance < distances_[other] || (distance == distances_[other] && index < indices_[other]);
    };
    if (full() && (at == 0 || !before(--at))) return true;
    for (; at > 0 && before(at - 1); --at) {
      distances_[at] = distances_[at - 1];
      indices_[at] = indices_[at - 1];
    }
    distances_[at] = distance;
    indices_[at] = index;
    count_ = std::min(count_ + 1, indices_.size());
    return true;
  }

 private:
  std::span<Index> indices_;
  std::span<double> distances_;
  std::size_t count_ = 0;
};

class NanoflannSearch final : public NeighborSearch {
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;

 public:
  explicit NanoflannSearch(std::span<const Vec3> points)
      : points_{points}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const override {
    NearestPoints result(indices, squared_distances);
    tree_.findNeighbors(result, query.data(), nanoflann::SearchParams());
    return static_cast<Index>(result.size());
  }

 private:
  Points points_;
  Tree tree_;
};

}  // namespace

std::unique_ptr<NeighborSearch> nanoflann_search(std::span<const Vec3> points) {
  return std::make_unique<NanoflannSearch>(points);
}

std::vector<Row> radius_search(std::span<const Vec3> points, const Vec3& center, double radius) {
  std::vector<Row> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    // Cheap test first; NaN fails it.
    if (std::abs(points[i][0] - center[0]) <= radius && distance(points[i], center) <= radius)
      result.emplace_back(static_cast<Index>(i));
  return result;
}

}  // namespace ahm::pointcloud
