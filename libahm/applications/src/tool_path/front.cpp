#include "tool_path/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Corner;
using detail::Half;
using exact::MeshPoint;

Vec3 corner_position(const FaceMesh& mesh, Half h) { return mesh.points[to_size(mesh.tail(h))]; }

/// A position in the plane of a face, as a point of the face. Rounding errors outside of it are cut off.
MeshPoint point_in_face(const FaceMesh& mesh, Index face, const Vec3& position) {
  const Vec3 a = corner_position(mesh, 3 * face), ab = corner_position(mesh, 3 * face + 1) - a,
             ac = corner_position(mesh, 3 * face + 2) - a, ap = position - a, normal = cross(ab, ac);
  const double area = dot(normal, normal), v = std::max(0.0, dot(cross(ap, ac), normal) / area),
               w = std::max(0.0, dot(cross(ab, ap), normal) / area), u = std::max(0.0, 1 - v - w), sum = u + v + w;
  return {face, {u / sum, v / sum, w / sum}};
}

/// A vector in the frame of a side as a vector in space. The x axis is the side, the y axis points into its face.
Vec3 in_space(const FaceMesh& mesh, Half side, const Vec2& vector) {
  const Vec3 x = normalized(mesh.points[to_size(mesh.head(side))] - corner_position(mesh, side)),
             y = cross(normalized(mesh.area_normal(side / 3)), x);
  return vector[0] * x + vector[1] * y;
}

/// The angle around a corner of a fine face from the right side of the first corner of its point to a direction in the plane
/// of the face.
double angle_around(const PathDomain& domain, Half corner, const Vec3& direction) {
  const Vec3 side = domain.mesh.points[to_size(domain.mesh.head(corner))] - corner_position(domain.mesh, corner);
  const Vec3 normal = normalized(domain.mesh.area_normal(corner / 3));
  return domain.surface.turned(Corner{corner, true}) +
         std::atan2(dot(cross(side, direction), normal), dot(side, direction));
}

/// A corner of a point in a part of a coarse face.
Half corner_in(const FineDomain& domain, Index point, Index coarse_face) {
  Corner c = domain.surface.first_corner(point);
  while (domain.parent[to_size(c.half / 3)] != coarse_face) c = domain.surface.turn_left(c);
  return c.half;
}

}  // namespace

exact::GeodesicPath PathDomain::path(const MeshPoint& from, const MeshPoint& to) const {
  const Vec3 end = mesh.position(to);
  return exact::locally_shortest_path(surface, from, to,
                                      [&](Vertex v) { return distance(mesh.points[to_size(v.index)], end); });
}

MeshPoint FineDomain::in_coarse(const MeshPoint& point) const {
  return point_in_face(coarse.mesh, parent[to_size(point.face)], mesh.position(point));
}

Front front(const FineDomain& domain, const std::vector<MeshPoint>& sources, double radius, const Progress& progress) {
  const PathDomain& coarse = domain.coarse;
  const std::size_t vertices = coarse.mesh.points.size(), points = domain.mesh.points.size();
  exact::ExactOptions options;
  options.radius = radius;
  options.progress = progress;
  for (std::size_t p = vertices; p < points; ++p) {
    const Half corner = domain.surface.first_corner(static_cast<Index>(p)).half;
    options.targets.push_back(point_in_face(coarse.mesh, domain.parent[to_size(corner / 3)], domain.mesh.points[p]));
  }
  std::vector<MeshPoint> coarse_sources;
  for (const MeshPoint& source : sources) coarse_sources.push_back(domain.in_coarse(source));
  const exact::ExactMap map = exact::exact_map(coarse.surface, coarse_sources, options);

  using Limits = std::numeric_limits<double>;
  Front result{std::vector<double>(points, Limits::infinity()), std::vector<double>(points, Limits::quiet_NaN())};
  const auto set = [&](std::size_t p, double distance, const exact::Arrival& arrival, const Vec2& at) {
    result.distance[p] = distance;
    if (arrival.half < 0) return;
    const Vec3 back = in_space(coarse.mesh, arrival.half, arrival.from - at);
    result.back[p] = angle_around(domain, corner_in(domain, static_cast<Index>(p), arrival.half / 3), back);
  };
  for (std::size_t p = 0; p < vertices; ++p) {
    const Vertex vertex(static_cast<Index>(p));
    if (map.status(vertex) != Status::ok) continue;
    const exact::Arrival& arrival = map.arrival(vertex);
    const exact::HalfRecord side = coarse.surface.record(std::max(arrival.half, 0));
    set(p, map.distance(vertex), arrival, {side.apex_x, side.apex_y});
  }
  for (std::size_t k = 0; k < map.targets(); ++k)
    if (map.target_status(k) == Status::ok)
      set(vertices + k, map.target_distance(k), map.target_arrival(k), coarse.surface.place(map.target(k)));
  return result;
}

}  // namespace ahm
