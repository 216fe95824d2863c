#include <nanoflann.hpp>

#include "ahm/pointcloud/neighbor_search.hpp"

namespace ahm::pointcloud {
namespace {

struct Points {
  std::span<const Vec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t point, std::size_t axis) const { return points[point][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class NanoflannSearch final : public NeighborSearch {
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;

 public:
  explicit NanoflannSearch(std::span<const Vec3> points)
      : points_{points}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const override {
    static_assert(sizeof(Index) == sizeof(std::uint32_t));
    nanoflann::KNNResultSet<double, std::uint32_t> result(indices.size());
    result.init(reinterpret_cast<std::uint32_t*>(indices.data()), squared_distances.data());
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

}  // namespace ahm::pointcloud
