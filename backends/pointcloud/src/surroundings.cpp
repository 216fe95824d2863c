#include "ahm/pointcloud/surroundings.hpp"

#include <cmath>

namespace ahm::pointcloud {

Surroundings surroundings(std::span<const Vec3> points, std::span<const Vec3> normals, const Vec3& center,
                          double radius) {
  Surroundings result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    // The cheap test first; NaN fails it.
    if (!(std::abs(p[0] - center[0]) <= radius) ||
        !(std::hypot(p[0] - center[0], p[1] - center[1], p[2] - center[2]) <= radius))
      continue;
    result.points.push_back(p);
    if (!normals.empty()) result.normals.push_back(normals[i]);
    result.index.push_back(static_cast<Index>(i));
  }
  return result;
}

}  // namespace ahm::pointcloud
