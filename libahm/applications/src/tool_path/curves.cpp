#include "tool_path/curves.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

using exact::MeshPoint;

namespace {

/// The point of a surface nearest to a position.
SurfacePoint point_near(const Surface& surface, const Vec3& position, double spacing, const std::string& name,
                        std::string_view fault) {
  const ClosestPoint closest = surface.closest_point(position);
  if (closest.distance > largest_curve_distance * spacing)
    throw InvalidArgument(
        fault, name + " is " + detail::number(closest.distance) + " from the surface, more than half of the spacing",
        "use a point on the surface");
  return closest.point;
}

}  // namespace

void check_positive(const std::string& name, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw InvalidArgument(name + " is " + detail::number(value) + "; it must be finite and > 0");
}

SurfacePoint surface_point(const Surface& surface, const CurvePoint& point, double spacing, const std::string& name,
                           std::string_view fault) {
  if (const auto* position = std::get_if<Vec3>(&point)) return point_near(surface, *position, spacing, name, fault);
  return std::get<SurfacePoint>(point);
}

SurfaceCurve drawn_curve(const Surface& surface, std::span<const Vec3> positions, bool closed, double spacing,
                         const std::string& name, std::string_view fault) {
  std::vector<CurvePoint> points;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    point_near(surface, positions[k], spacing, "point " + std::to_string(k) + " of the " + name + " curve", fault);
    points.emplace_back(positions[k]);
  }
  return draw_curve(surface, points, {.closed = closed});
}

MeshCurve on_mesh(const PathDomain& domain, std::span<const Vec3> points, bool closed, double spacing,
                  const std::string& name, std::string_view fault) {
  const MeshTree tree(domain.mesh);
  std::vector<MeshPoint> found;
  for (const Vec3& p : points)
    if (const MeshTree::Hit hit = tree.nearest((1 / spacing) * p); hit.distance < largest_curve_distance)
      found.push_back(hit.point);
  if (found.size() < 2)
    throw InvalidArgument(fault, "the " + name + " curve does not lie in the part that is covered",
                          "choose a curve there");
  const Index component = domain.surface.component(found.front());
  if (!std::ranges::all_of(found, [&](const MeshPoint& p) { return domain.surface.component(p) == component; }))
    throw InvalidArgument("curve_disconnected", "the surface does not connect the points of the " + name + " curve",
                          "use points of one component");
  return joined_curve(domain, found, closed && found.size() == points.size());
}

}  // namespace ahm
