#include "ahm/surface/surface_paths.hpp"

#include <algorithm>

#include "ahm/error.hpp"
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

Vec3 to_space(const std::optional<Vec3>& position) {
  if (!position) throw InvalidArgument("lines in space require a graph with frames");
  return *position;
}

SurfacePath to_space(const TangentGraph& graph, const TangentLine& found) {
  SurfacePath line{found.status, {}, found.length, found.complete};
  for (const TangentPlanePoint& place : found.places) line.points.push_back(to_space(smooth_position(graph, place)));
  if (line.points.empty()) return line;
  line.points.front() = to_space(position(graph, found.places.front()));
  line.points.back() = to_space(position(graph, found.places.back()));
  line.length = std::max(line.length, distance(line.points.front(), line.points.back()));
  return line;
}

TangentPlanePoint place_of(const Surface& surface, const SurfacePoint& point) {
  return tangent_plane_point(surface.source(point).source);
}

}  // namespace

SurfacePath shortest_line(const Surface& surface, const SurfacePoint& from, const SurfacePoint& to) {
  SurfacePath line =
      to_space(surface.graph(), shortest_line(surface.graph(), place_of(surface, from), place_of(surface, to)));
  if (line.points.empty()) return line;
  // The line may end in the tangent plane of another vertex: use the positions of the two points.
  line.points.front() = surface.position(from);
  line.points.back() = surface.position(to);
  line.length = std::max(line.length, distance(line.points.front(), line.points.back()));
  return line;
}

SurfacePath trace_line(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double length) {
  const Source source = surface.source(from, direction).source;
  return to_space(surface.graph(),
                  trace_line(surface.graph(), tangent_plane_point(source), u_axis_at_point(source), length));
}

}  // namespace ahm
