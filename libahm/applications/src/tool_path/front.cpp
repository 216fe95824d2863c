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

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Vec3 corner_position(const FaceMesh& mesh, Half h) { return mesh.points[to_size(mesh.tail(h))]; }

/// A position in the plane of a face, as a point of the face. Rounding errors outside of it are cut off.
MeshPoint placed(const FaceMesh& mesh, Index face, const Vec3& position) {
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

/// The corner of a point in a part of a coarse face; -1: none.
Half corner_in(const FineDomain& domain, Half any_corner, Index coarse_face) {
  const Corner first = domain.surface.first_corner(domain.mesh.tail(any_corner));
  for (Corner c = first; c.half >= 0;) {
    if (domain.coarse_face[to_size(c.half / 3)] == coarse_face) return c.half;
    c = domain.surface.turn_left(c);
    if (c == first) break;
  }
  return -1;
}

}  // namespace

MeshPoint FineDomain::in_coarse(const MeshPoint& point) const {
  return placed(coarse.mesh, coarse_face[to_size(point.face)], mesh.position(point));
}

Front front(const FineDomain& domain, const std::vector<MeshPoint>& sources, double radius, const Progress& progress) {
  const PathDomain& coarse = domain.coarse;
  exact::ExactOptions options;
  options.radius = radius;
  options.progress = progress;
  std::vector<Half> corners(domain.mesh.points.size(), -1);  // a corner of each point
  for (std::size_t h = 0; h < 3 * domain.mesh.size(); ++h) {
    const auto corner = static_cast<Half>(h);
    const Index p = domain.mesh.tail(corner);
    if (corners[to_size(p)] >= 0) continue;
    corners[to_size(p)] = corner;
  }
  std::vector<std::size_t> target(domain.mesh.points.size());
  for (std::size_t p = 0; p < corners.size(); ++p) {
    if (domain.coarse_point[p] >= 0) continue;
    target[p] = options.targets.size();
    options.targets.push_back(placed(coarse.mesh, domain.coarse_face[to_size(corners[p] / 3)], domain.mesh.points[p]));
  }
  std::vector<MeshPoint> coarse_sources;
  for (const MeshPoint& source : sources) coarse_sources.push_back(domain.in_coarse(source));
  const exact::ExactMap map = exact::exact_map(coarse.surface, coarse_sources, options);

  Front result{std::vector<double>(corners.size(), infinity), std::vector<double>(corners.size(), nan)};
  for (std::size_t p = 0; p < corners.size(); ++p) {
    const Vertex vertex(domain.coarse_point[p]);
    const bool is_vertex = vertex.index >= 0;
    if ((is_vertex ? map.status(vertex) : map.target_status(target[p])) != Status::ok) continue;
    result.distance[p] = is_vertex ? map.distance(vertex) : map.target_distance(target[p]);
    const exact::Arrival& arrival = is_vertex ? map.arrival(vertex) : map.target_arrival(target[p]);
    if (arrival.half < 0) continue;
    const exact::HalfRecord side = coarse.surface.record(arrival.half);
    const Vec2 at = is_vertex ? Vec2{side.apex_x, side.apex_y} : coarse.surface.place(map.target(target[p]));
    const Vec3 back = in_space(coarse.mesh, arrival.half, arrival.from - at);
    result.back[p] = angle_around(domain, corner_in(domain, corners[p], arrival.half / 3), back);
  }
  return result;
}

}  // namespace ahm
