#include <algorithm>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"

#ifdef AHM_WITH_FLANN
#include <flann/flann.hpp>
#endif

namespace ahm::pointcloud {

#ifdef AHM_WITH_FLANN
namespace {

class FlannSearch final : public NeighborSearch {
 public:
  explicit FlannSearch(std::span<const Vec3> points)
      : size_(points.size()),
        // FLANN's matrix type is not const-correct; the index only reads the points.
        tree_(flann::Matrix<double>(const_cast<double*>(points.front().data()), points.size(), 3),
              flann::KDTreeSingleIndexParams(16)) {
    tree_.buildIndex();
  }

  Index nearest(const Vec3& query, std::span<Index> indices, std::span<double> squared_distances) const override {
    const std::size_t wanted = std::min(indices.size(), size_);
    if (wanted == 0) return 0;
    // A few more than needed: until the last one is farther away, others may be as near as the last one needed.
    std::vector<Candidate> found;
    for (std::size_t count = std::min(wanted + 4, size_);; count = std::min(2 * count, size_)) {
      find(query, count, found);
      if (count == size_ || found[count - 1].first > found[wanted - 1].first * (1 + 1e-14)) break;
    }
    take_nearest(found, wanted, indices, squared_distances);
    return static_cast<Index>(wanted);
  }

 private:
  /// The `count` nearest points, nearest first.
  void find(const Vec3& query, std::size_t count, std::vector<Candidate>& found) const {
    std::vector<std::size_t> indices(count);
    std::vector<double> squared(count);
    const flann::Matrix<double> point(const_cast<double*>(query.data()), 1, 3);
    flann::Matrix<std::size_t> index_row(indices.data(), 1, count);
    flann::Matrix<double> distance_row(squared.data(), 1, count);
    flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
    exact.cores = 1;
    tree_.knnSearch(point, index_row, distance_row, count, exact);
    found.clear();
    for (std::size_t i = 0; i < count; ++i) found.emplace_back(squared[i], static_cast<Index>(indices[i]));
  }

  std::size_t size_;
  flann::Index<flann::L2_Simple<double>> tree_;
};

}  // namespace

std::unique_ptr<NeighborSearch> flann_search(std::span<const Vec3> points) {
  return std::make_unique<FlannSearch>(points);
}

#else

std::unique_ptr<NeighborSearch> flann_search(std::span<const Vec3>) {
  throw InvalidArgument("flann_search: this build has no FLANN (AHM_WITH_FLANN=OFF); use nanoflann_search");
}

#endif

}  // namespace ahm::pointcloud
