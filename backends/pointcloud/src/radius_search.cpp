#include "ahm/pointcloud/radius_search.hpp"

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {

std::vector<Row> radius_search(std::span<const Vec3> points, const Vec3& center, double radius) {
  std::vector<Row> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    // The cheap test first; NaN fails it.
    if (std::abs(points[i][0] - center[0]) <= radius && distance(points[i], center) <= radius)
      result.emplace_back(static_cast<Index>(i));
  return result;
}

}  // namespace ahm::pointcloud
