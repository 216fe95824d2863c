#include "ahm/surface/exact/geodesic_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "check_point.hpp"
#include "strip.hpp"
#include "walk.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

/// Crossings closer than this multiple of its length to an end of a straight piece are that end.
constexpr double end_margin = 1e-11;
/// A line that leaves a face closer than this multiple of the side to a corner goes through the vertex.
constexpr double vertex_margin = 1e-12, graze_margin = 1e-10;

double positive_angle(double angle) { return angle < 0 ? angle + 2 * pi : angle; }

/// Collects a path from its end to its source.
class Backwards {
 public:
  Backwards(const PolyhedralSurface& surface, const ExactMap& map) : surface_(surface), map_(map) {}

  GeodesicPath to_vertex(Index vertex) {
    const Arrival& in = map_.arrival(Vertex{vertex});
    if (in.half >= 0) {
      const Half corner = previous(in.half);
      path_.end_direction = angle_at_vertex(surface_, corner, in_previous(surface_.record(in.half), in.from)) *
                            surface_.angle_scale(vertex);
      back_from(vertex);
    }
    return finish(in.origin, map_.distance(Vertex{vertex}), map_.direction(Vertex{vertex}));
  }

  GeodesicPath to_target(std::size_t k) {
    const MeshPoint& target = map_.target(k);
    const Arrival& in = map_.target_arrival(k);
    const Vec2 place = surface_.place(target);
    path_.points.push_back(target);
    path_.end_direction = positive_angle(std::atan2(in.from[1] - place[1], in.from[0] - place[0]));
    back_from(piece(in, place, map_.target_distance(k), &target));
    return finish(in.origin, map_.target_distance(k), map_.target_direction(k));
  }

 private:
  /// From a vertex back to the source, which is not added; -1: that is where the path is.
  void back_from(Index vertex) {
    while (vertex >= 0 && map_.arrival(Vertex{vertex}).half >= 0) {
      path_.points.push_back(surface_.vertex_point(Vertex{vertex}));
      const Arrival& in = map_.arrival(Vertex{vertex});
      vertex = piece(in, apex(surface_.record(in.half)), map_.distance(Vertex{vertex}), nullptr);
    }
  }

  /// Adds the crossings of the straight piece that comes in at a place of its last face, or at its apex.
  /// @param target  at that place; null: at the apex
  /// @return the vertex it comes from, or the first it goes through: both sides of that may be covered by windows, within
  ///         rounding, but only its own map says which one is right. -1: a source that is no vertex.
  Index piece(const Arrival& in, const Place& end, double end_distance, const MeshPoint* target) {
    const Origin& origin = map_.origins()[in.origin];
    const Place back = in.from - end;
    const double length = norm(back);
    if (!(length > 0)) return origin.vertex;
    Line line{in.half, end, {back[0] / length, back[1] / length}};
    Exit exit = target ? leave(surface_, line) : leave_through(surface_, line, in.half);
    const auto at_end = [&] { return exit.walked >= (1 - end_margin) * length; };
    const auto with_source = [&] { return lies_in(map_.sources()[origin.source], line.half / 3); };
    const auto arrived = [&] {
      return at_end() && (origin.vertex >= 0 || with_source() || exit.walked > (1 + end_margin) * length);
    };
    while (!arrived()) {
      const Index through = grazed(exit, end_distance);
      if (through >= 0) return through;
      if (!(target && exit.walked <= end_margin * length && lies_on(*target, exit.side)))
        path_.points.push_back(point_on(surface_, exit.side, exit.along));
      const Line across = cross_side(surface_, line, exit);
      if (across.half < 0 && origin.vertex < 0 && (at_end() || with_source())) return -1;
      if (across.half < 0) return end_of_side(line, exit, end_distance);
      if (path_.points.size() > most_points()) lost(exit, end_distance);
      line = across;
      exit = leave_upwards(surface_, line);
    }
    return origin.vertex;
  }

  static bool lies_on(const MeshPoint& point, Half side) {
    return point.face == side / 3 && point.barycentric[previous(side) % 3] == 0;
  }
  bool lies_in(const MeshPoint& point, Index face) const {
    if (point.face == face) return true;
    for (Half side = 3 * point.face; side < 3 * point.face + 3; ++side)
      if (lies_on(point, side) && beyond(surface_, side) >= 0 && beyond(surface_, side) / 3 == face) return true;
    return false;
  }

  /// The vertex at an exit, if shortest paths to it are part of this one.
  Index grazed(const Exit& exit, double end_distance) const {
    const HalfRecord& r = surface_.record(exit.side);
    const bool at_tail = exit.along < graze_margin * r.length;
    if (!at_tail && exit.along < (1 - graze_margin) * r.length) return -1;
    const Index vertex = at_tail ? r.tail : r.head;
    return passes(vertex, exit.walked, end_distance) ? vertex : -1;
  }

  /// Where a path that runs along the boundary leaves it by rounding: the vertex ahead, which shortest paths pass.
  Index end_of_side(const Line& line, const Exit& exit, double end_distance) const {
    const HalfRecord& r = surface_.record(exit.side);
    const bool to_head = in_frame_of(surface_, line, exit.side).direction[0] > 0;
    const Index vertex = to_head ? r.head : r.tail;
    const double walked = exit.walked + (to_head ? r.length - exit.along : exit.along);
    if (!passes(vertex, walked, end_distance)) lost(exit, end_distance);
    return vertex;
  }

  /// Whether shortest paths to a vertex, which a path has come back to, are part of this one.
  bool passes(Index vertex, double walked, double end_distance) const {
    const double left = map_.distance(Vertex{vertex});
    return left < end_distance && std::abs(left + walked - end_distance) <= 1e-9 * end_distance;
  }

  [[noreturn]] static void lost(const Exit& exit, double end_distance) {
    throw Error("a path of length " + detail::number(end_distance) + " was lost beyond face " +
                std::to_string(exit.side / 3));
  }

  std::size_t most_points() const { return 3 * static_cast<std::size_t>(surface_.face_count()) + 3; }

  GeodesicPath finish(Index origin, double distance, double direction) {
    path_.length = distance;
    path_.start_direction = direction;
    path_.source = map_.origins()[origin].source;
    if (distance > 0 || path_.points.empty()) path_.points.push_back(map_.sources()[path_.source]);
    std::reverse(path_.points.begin(), path_.points.end());
    return std::move(path_);
  }

  const PolyhedralSurface& surface_;
  const ExactMap& map_;
  GeodesicPath path_;
};

void check_exact(const ExactMap& map) {
  if (map.tolerance() > 0)
    throw InvalidArgument("'map' has the tolerance " + detail::number(map.tolerance()) + "; paths need an exact one");
}

/// Directions this far beyond the boundary run along it.
constexpr double boundary_margin = 1e-9;
/// Lines of more are taken for lost.
constexpr std::size_t most_crossings = 1000000;

GeodesicPath without_points(Status status) {
  GeodesicPath path;
  path.status = status;
  return path;
}

/// Follows a straightest geodesic.
class Tracer {
 public:
  Tracer(const PolyhedralSurface& surface, double length) : surface_(surface), length_(length), left_(length) {}

  TracedPath from(const MeshPoint& start, Line line) {
    path_.points.push_back(start);
    const bool at_vertex = vertex_of(surface_, start) >= 0;
    for (Exit exit = at_vertex ? leave_corner(line) : leave(surface_, line);;) {
      if (left_ <= exit.walked)
        return end(TraceEnd::complete, line, left_, point_of(surface_, line.half, line.at(left_)));
      const double side = surface_.record(exit.side).length;
      const bool at_tail = exit.along<vertex_margin * side, at_head = exit.along>(1 - vertex_margin) * side;
      if (at_tail || at_head) {
        const Half corner = at_tail ? exit.side : next(exit.side);
        const Index vertex = surface_.record(corner).tail;
        const std::optional<double> out = straight_on(line, corner);
        if (!out) return end(TraceEnd::boundary, line, exit.walked, surface_.vertex_point(Vertex{vertex}));
        done_ += exit.walked;
        left_ -= exit.walked;
        path_.points.push_back(surface_.vertex_point(Vertex{vertex}));
        line = line_from_vertex(surface_, vertex, *out);
        check_count(done_);
        exit = leave_corner(line);
        continue;
      }
      const Line beyond = cross_side(surface_, line, exit);
      const MeshPoint crossed = point_on(surface_, exit.side, exit.along);
      if (beyond.half < 0) return end(TraceEnd::boundary, line, exit.walked, crossed);
      path_.points.push_back(crossed);
      check_count(done_ + exit.walked);
      line = beyond;
      exit = leave_upwards(surface_, line);
    }
  }

 private:
  TracedPath end(TraceEnd how, const Line& line, double walked, const MeshPoint& point) {
    path_.end = how;
    path_.length = done_ + walked;
    path_.direction = positive_angle(angle_in_face(surface_, line));
    path_.points.push_back(point);
    return std::move(path_);
  }

  void check_count(double walked) const {
    if (path_.points.size() < most_crossings) return;
    throw InvalidArgument("line_too_long",
                          "the line crosses more than " + std::to_string(most_crossings) + " sides within " +
                              detail::number(walked) + " of its length " + detail::number(length_) + ", near face " +
                              std::to_string(path_.points.back().face),
                          "give a smaller length, or repair needles there");
  }

  /// Leaves the face opposite to the corner that the line starts in.
  Exit leave_corner(const Line& line) const { return leave_through(surface_, line, next(line.half)); }

  /// The angle at which a line goes on at the vertex of a corner: half of the vertex's angle lies on either side; on the
  /// boundary pi on one, or nowhere.
  std::optional<double> straight_on(const Line& line, Half corner) const {
    const Index vertex = surface_.record(corner).tail;
    const Line seen = in_frame_of(surface_, line, corner);
    const double sum = surface_.angle_sum(vertex);
    const double in = angle_at_vertex(surface_, corner, -seen.direction);
    if (!surface_.on_boundary(vertex)) return in < sum / 2 ? in + sum / 2 : in - sum / 2;
    if (in + pi <= sum + boundary_margin) return std::min(in + pi, sum);
    if (in - pi >= -boundary_margin) return std::max(in - pi, 0.0);
    return std::nullopt;
  }

  const PolyhedralSurface& surface_;
  double length_;
  double left_;      ///< to go from the start of the current line
  double done_ = 0;  ///< up to there
  TracedPath path_;
};

}  // namespace

GeodesicPath path_to_vertex(const PolyhedralSurface& surface, const ExactMap& map, Vertex vertex) {
  if (vertex.index < 0 || vertex.index >= map.size() || map.size() != surface.vertex_count())
    throw InvalidArgument("vertex " + std::to_string(vertex.index) + " is outside [0, " + std::to_string(map.size()) +
                          "), or the map is of another surface");
  check_exact(map);
  if (map.status(vertex) != Status::ok) return without_points(map.status(vertex));
  return Backwards(surface, map).to_vertex(vertex.index);
}

GeodesicPath path_to_target(const PolyhedralSurface& surface, const ExactMap& map, std::size_t target) {
  if (target >= map.targets() || map.size() != surface.vertex_count())
    throw InvalidArgument("target " + std::to_string(target) + " is outside [0, " + std::to_string(map.targets()) +
                          "), or the map is of another surface");
  check_exact(map);
  if (map.target_status(target) != Status::ok) return without_points(map.target_status(target));
  if (const Index vertex = vertex_of(surface, map.target(target)); vertex >= 0)
    return Backwards(surface, map).to_vertex(vertex);
  return Backwards(surface, map).to_target(target);
}

GeodesicPath geodesic_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to) {
  ExactOptions options;
  options.targets.push_back(to);
  options.only_targets = true;
  return path_to_target(surface, exact_map(surface, from, options), 0);
}

GeodesicPath geodesic_path(const PolyhedralSurface& surface, std::span<const MeshPoint> stops, bool closed) {
  if (stops.size() < 2)
    throw InvalidArgument("'stops' has " + std::to_string(stops.size()) + " points; a path needs 2");
  GeodesicPath path = geodesic_path(surface, stops[0], stops[1]);
  const std::size_t legs = stops.size() - (closed ? 0 : 1);
  for (std::size_t k = 1; k < legs && path.status == Status::ok; ++k) {
    const GeodesicPath leg = geodesic_path(surface, stops[k], stops[(k + 1) % stops.size()]);
    if (leg.status != Status::ok) return without_points(leg.status);
    path.points.insert(path.points.end(), leg.points.begin() + 1, leg.points.end());
    path.length += leg.length;
    path.end_direction = leg.end_direction;
  }
  return path;
}

TracedPath trace(const PolyhedralSurface& surface, const MeshPoint& from, double direction, double length) {
  const MeshPoint start = checked(surface, from, "from");
  if (!std::isfinite(direction)) throw InvalidArgument("'direction' is not finite");
  if (!(length >= 0) || !std::isfinite(length))
    throw InvalidArgument("'length' is " + detail::number(length) + "; it must be finite and >= 0");
  const Index vertex = vertex_of(surface, start);
  if (vertex < 0) {
    const Vec2 place = surface.place(start);
    return Tracer(surface, length).from(start, line_from(3 * start.face, place, direction));
  }
  const double sum = surface.angle_sum(vertex);
  double angle = direction / surface.angle_scale(vertex);
  if (!surface.on_boundary(vertex))
    angle -= sum * std::floor(angle / sum);
  else if (angle > sum && angle > 2 * pi - boundary_margin)
    angle = 0;  // along the first side, by rounding
  if (angle < -boundary_margin || angle > sum + boundary_margin)
    throw InvalidArgument("the direction leads out of the surface at vertex " + std::to_string(vertex) +
                          " of its boundary: as an angle from the first side it is " + detail::number(direction) +
                          ", those of the surface are up to " + detail::number(sum));
  return Tracer(surface, length).from(surface.vertex_point(Vertex{vertex}), line_from_vertex(surface, vertex, angle));
}

}  // namespace ahm::exact
