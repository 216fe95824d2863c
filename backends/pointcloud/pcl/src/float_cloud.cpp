#include "float_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"

namespace ahm::pcl_bridge {
namespace {

void require_finite(std::span<const Vec3> points, std::string_view caller) {
  for (std::size_t i = 0; i < points.size(); ++i)
    for (double x : points[i])
      if (!std::isfinite(x))
        throw InvalidGeometry(std::string(caller) + ": point " + std::to_string(i) + " has the coordinate " +
                              std::to_string(x) + "; remove non-finite points first");
}

}  // namespace

FloatCloud to_float_cloud(std::span<const Vec3> points, std::string_view caller) {
  require_finite(points, caller);
  FloatCloud result{::pcl::make_shared<::pcl::PointCloud<::pcl::PointXYZ>>(), {}, 1.0, {}};
  if (points.empty()) return result;
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points)
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  double half = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    result.center[a] = 0.5 * low[a] + 0.5 * high[a];  // halves first: the sum may overflow
    half = std::max({half, high[a] - result.center[a], result.center[a] - low[a]});
  }
  if (half > 0) {
    int exponent = 0;
    std::frexp(half, &exponent);
    result.unit = std::ldexp(1.0, std::clamp(exponent, -1022, 1023));
  }
  for (std::size_t a = 0; a < 3; ++a) result.extent[a] = high[a] / result.unit - low[a] / result.unit;
  result.cloud->reserve(points.size());
  for (const Vec3& p : points) result.cloud->push_back(result.convert(p));
  return result;
}

}  // namespace ahm::pcl_bridge
