#include "cloud_parts.hpp"

#include "ahm/util/disjoint_sets.hpp"

namespace ahm::pointcloud {

CloudParts::CloudParts(const Neighborhoods& neighborhoods) {
  const auto n = static_cast<Index>(neighborhoods.radius.size());
  detail::DisjointSets sets(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i)
    for (const Index j : neighborhoods.of(i)) sets.join(i, j);
  of_point.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const Index root = sets.root(i);
    of_point[i] = root == i ? count++ : of_point[root];
  }
}

std::vector<std::vector<Index>> CloudParts::points() const {
  std::vector<std::vector<Index>> result(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < of_point.size(); ++i) result[of_point[i]].push_back(static_cast<Index>(i));
  return result;
}

}  // namespace ahm::pointcloud
