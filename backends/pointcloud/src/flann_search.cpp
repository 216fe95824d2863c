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
    const std::size_t k = std::min(indices.size(), size_);
    std::vector<std::size_t> found(k);
    const flann::Matrix<double> point(const_cast<double*>(query.data()), 1, 3);
    flann::Matrix<std::size_t> index_row(found.data(), 1, k);
    flann::Matrix<double> distance_row(squared_distances.data(), 1, k);
    flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
    exact.cores = 1;
    const int count = tree_.knnSearch(point, index_row, distance_row, k, exact);
    std::copy_n(found.begin(), count, indices.begin());
    return static_cast<Index>(count);
  }

 private:
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
