#include "ahm/surface/exact/geodesic_derivatives.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "exact/propagation.hpp"

namespace ahm {
namespace {

TangentMap sum_of(const TangentMap& a, const TangentMap& b) {
  TangentMap result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = a[k] + b[k];
  return result;
}

/// The map of `from` to `to`, and of vectors orthogonal to `from` to zero. `from` is a unit vector.
TangentMap outer(const Vec3& to, const Vec3& from) {
  TangentMap result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[3 * i + j] = to[i] * from[j];
  return result;
}

/// Position of a corner of a face, in units of the triangles.
Vec3 corner_position(const FlatTriangles& flat, Index face, int s) {
  return (1 / flat.length_unit) * flat.positions[flat.surface.record(3 * face + s % 3).tail];
}

/// A tangent plane, with axes such that direction a (`exact::ExactMap::direction`) is cos(a) x + sin(a) y.
struct TangentPlane {
  Vec3 x, y;
  double angle_scale = 1;  ///< angle in the plane per angle on the triangles

  Vec3 along(double a) const { return std::cos(a) * x + std::sin(a) * y; }
  Vec3 left(double a) const { return std::cos(a) * y - std::sin(a) * x; }
  TangentMap identity() const { return sum_of(outer(x, x), outer(y, y)); }
};

TangentPlane plane_of_face(const FlatTriangles& flat, Index face) {
  const Vec3 side = corner_position(flat, face, 1) - corner_position(flat, face, 0),
             other = corner_position(flat, face, 2) - corner_position(flat, face, 0);
  return {normalized(side), normalized(cross(cross(side, other), side))};
}

TangentPlane plane_at(const ExactGeodesics& geodesics, const exact::MeshPoint& point) {
  const FlatTriangles& flat = geodesics.triangles();
  const Index vertex = exact::vertex_of(flat.surface, point);
  if (vertex < 0) return plane_of_face(flat, point.face);
  const std::optional<Frame> frame = geodesics.surface().graph().frame(vertex);
  if (!frame) throw InvalidArgument("vertex " + std::to_string(vertex) + " has no frame in space");
  const double zero = flat.angles.empty() ? 0 : flat.angles[vertex];
  const double side = flat.mirrored.empty() || flat.mirrored[vertex] == 0 ? 1 : -1;
  return {std::cos(zero) * frame->x + std::sin(zero) * frame->y,
          side * (std::cos(zero) * frame->y - std::sin(zero) * frame->x), flat.surface.angle_scale(vertex)};
}

void check_derivatives(const ExactGeodesics& geodesics) {
  if (geodesics.triangles().positions.empty()) throw InvalidArgument("the surface has no positions");
  if (geodesics.surface().graph().transport_layout().may_reflect())
    throw InvalidArgument("not_orientable", "the surface is not orientable, so its geodesics have no derivatives here",
                          "cut the surface open");
}

exact::MeshPoint triangle_point(const ExactGeodesics& geodesics, const SurfacePoint& point, const char* name) {
  return exact::checked(geodesics.triangles().surface, geodesics.point(point), name);
}

/// The motion of the point where a line meets the boundary, per unit of motion of the line to its left. Zero at a vertex.
/// @param end  on the boundary
Vec3 sliding(const FlatTriangles& flat, const exact::MeshPoint& end, const Vec3& left) {
  if (exact::vertex_of(flat.surface, end) >= 0) return {};
  int opposite = 0;  // the corner opposite to the side with the point
  while (opposite < 2 && end.barycentric[opposite] > 0) ++opposite;
  const Vec3 side =
      normalized(corner_position(flat, end.face, opposite + 2) - corner_position(flat, end.face, opposite + 1));
  const double share = dot(side, left);
  return share == 0 ? Vec3{} : (1 / share) * side;
}

}  // namespace

ExponentialPoint exponential_point(const ExactGeodesics& geodesics, const SurfacePoint& start, const Vec3& vector) {
  check_derivatives(geodesics);
  if (!is_finite(vector)) throw InvalidArgument("the vector is not finite");
  const FlatTriangles& flat = geodesics.triangles();
  const exact::MeshPoint from = triangle_point(geodesics, start, "start");
  const TangentPlane plane = plane_at(geodesics, from);
  const double u = dot(vector, plane.x), v = dot(vector, plane.y), length = std::hypot(u, v);
  if (length == 0) return {geodesics.position(from), true, plane.identity(), plane.identity()};

  double direction = std::atan2(v, u);
  if (direction < 0) direction += 2 * std::numbers::pi;
  const exact::TracedPath path = exact::trace(flat.surface, from, direction, length / flat.length_unit);
  const exact::MeshPoint& to = path.points.back();
  const TangentPlane there = plane_of_face(flat, to.face);
  ExponentialPoint end{geodesics.position(to), path.end == exact::TraceEnd::complete};
  Vec3 forward = there.along(path.direction), sideways = there.left(path.direction);
  if (!end.complete) {
    sideways = sliding(flat, to, sideways);
    forward = {};
  }
  // A turn of the vector by an angle moves the end by this angle times the length of the line.
  const double turned = path.length * flat.length_unit / length / plane.angle_scale;
  const TangentMap of_forward = outer(forward, plane.along(direction));
  end.by_start = sum_of(of_forward, outer(sideways, plane.left(direction)));
  end.by_vector = sum_of(of_forward, outer(turned * sideways, plane.left(direction)));
  return end;
}

namespace {

/// The length of a path up to the first vertex at which it may bend, world units; none if it is straight.
std::optional<double> straight_length(const ExactGeodesics& geodesics, const exact::GeodesicPath& path) {
  const exact::PolyhedralSurface& surface = geodesics.triangles().surface;
  double length = 0;
  for (std::size_t k = 1; k + 1 < path.points.size(); ++k) {
    length += distance(geodesics.position(path.points[k - 1]), geodesics.position(path.points[k]));
    const Index vertex = exact::vertex_of(surface, path.points[k]);
    if (vertex >= 0 && surface.bends_paths(vertex)) return length;
  }
  return std::nullopt;
}

/// @param ends  start and end of the path
GeodesicEnds ends_of(const ExactGeodesics& geodesics, const exact::GeodesicPath& path, const exact::PointPair& ends) {
  if (path.status != Status::ok) return {.status = path.status};
  const TangentPlane here = plane_at(geodesics, ends[0]), there = plane_at(geodesics, ends[1]);
  const bool is_same = ends[0].face == ends[1].face && ends[0].barycentric == ends[1].barycentric;
  GeodesicEnds result;
  if (is_same || path.length == 0) {  // the length may be a rounding error
    result.log_by_target = here.identity();
    for (std::size_t k = 0; k < result.log_by_source.size(); ++k) result.log_by_source[k] = -result.log_by_target[k];
    return result;
  }
  result.distance = path.length * geodesics.triangles().length_unit;
  result.departure = here.along(path.start_direction);
  result.arrival = -there.along(path.end_direction);
  const Vec3 left = here.left(path.start_direction), left_there = -there.left(path.end_direction);
  const std::optional<double> straight = straight_length(geodesics, path);
  // Where the path bends, the direction at the source does not depend on the target.
  const TangentMap along = outer(result.departure, result.arrival);
  result.log_by_target = straight ? along : sum_of(along, outer(here.angle_scale * left, left_there));
  const double turned = straight ? result.distance / *straight : 1;
  result.log_by_source = sum_of(outer(-result.departure, result.departure), outer(-turned * left, left));
  return result;
}

}  // namespace

std::vector<GeodesicEnds> geodesic_ends(const ExactGeodesics& geodesics,
                                        std::span<const std::array<SurfacePoint, 2>> pairs, const Progress& progress,
                                        unsigned threads) {
  check_derivatives(geodesics);
  std::vector<exact::PointPair> ends;
  for (const auto& [source, target] : pairs)
    ends.push_back({triangle_point(geodesics, source, "source"), triangle_point(geodesics, target, "target")});
  const auto paths = exact::geodesic_paths(geodesics.triangles().surface, ends, progress, threads);
  std::vector<GeodesicEnds> result;
  for (std::size_t k = 0; k < paths.size(); ++k) result.push_back(ends_of(geodesics, paths[k], ends[k]));
  return result;
}

}  // namespace ahm
