#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ahm/applications/mean.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "joined_points.hpp"

namespace ahm {
namespace {

/// From a vertex in the axes of its frame. What leads out of the surface at once goes along the boundary as far as it does.
Vec3 end_of_trace(const ExactGeodesics& geodesics, const Center& center) {
  constexpr double pi = std::numbers::pi;
  const exact::PolyhedralSurface& surface = geodesics.triangles().surface;
  double direction = std::atan2(center.offset[1], center.offset[0]), far = length(center.offset);
  if (direction < 0) direction += 2 * pi;
  if (const double sum = surface.angle_sum(center.vertex.index);
      surface.on_boundary(center.vertex.index) && direction > sum) {
    const double left = direction - sum, right = 2 * pi - direction;
    far *= std::max(0.0, std::cos(std::min(left, right)));
    direction = left < right ? sum : 0;
  }
  const exact::TracedPath way =
      exact::trace(surface, surface.vertex_point(center.vertex), direction, far / geodesics.triangles().length_unit);
  return geodesics.position(way.points.back());
}

Vec3 end_of_line(const TangentGraph& graph, const Center& center) {
  const Vec2 offset{center.offset[0], center.offset[1]};
  const TangentLine line = trace_line(graph, {center.vertex}, offset, length(offset));
  return position(graph, line.places.back()).value();
}

}  // namespace

Vec3 center_position(const Surface& surface, const Center& center) {
  const TangentGraph& graph = surface.graph();
  if (surface.positions().empty()) throw InvalidArgument("the surface has no positions");
  if (center.vertex.index < 0 || center.vertex.index >= graph.size() || center.offset.size() != 2)
    throw InvalidArgument("the center, at vertex " + std::to_string(center.vertex.index) +
                          ", is one of another surface");
  const Frame frame = graph.frame(center.vertex.index).value();
  if (length(center.offset) == 0) return frame.origin;
  if (surface.faces().size() == 0) return end_of_line(graph, center);
  const FlatFaces faces(surface);
  if (faces.geodesics) return end_of_trace(*faces.geodesics, center);
  return surface.closest_point(frame.origin + center.offset[0] * frame.x + center.offset[1] * frame.y).position;
}

}  // namespace ahm
