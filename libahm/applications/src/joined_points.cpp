#include "joined_points.hpp"

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// Points this near to a straight line, relative to its length, lie on it.
constexpr double straight = 1e-11;

bool lies_between(const Vec3& from, const Vec3& at, const Vec3& to) {
  const double far = length(to - from);
  return !(far > 0) || length(cross((1 / far) * (at - from), (1 / far) * (to - from))) <= straight;
}

}  // namespace

FlatFaces::FlatFaces(const Surface& surface) {
  if (surface.faces().size() == 0 || surface.positions().empty()) return;
  try {
    geodesics.emplace(surface);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {  // twisted polygons, faces of no area
    reason = e.what();
  }
}

std::vector<Vec3> bends(const ExactGeodesics& geodesics, const exact::GeodesicPath& path) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Vec3 at = geodesics.position(path.points[k]);
    if (k > 0 && k + 1 < path.points.size() && lies_between(kept.back(), at, geodesics.position(path.points[k + 1])))
      continue;
    kept.push_back(at);
  }
  return kept;
}

}  // namespace ahm
