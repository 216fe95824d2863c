#include "exact/geodesic_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <string>
#include <tuple>

#include "ahm/error.hpp"
#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "exact/shortened_path.hpp"

namespace ahm::exact {
namespace {

/// The line in another frame; `place` converts points to that frame.
template <class Map>
Line mapped(const Line& line, Half half, const Map& place) {
  const Place start = place(line.start), ahead = place({0, 0});
  const Place tip = place(line.direction) - ahead;
  return {half, start, tip, line.walked_length};
}

/// Where the line crosses the side from a to b of the given length; its ends belong to the side.
Exit crossing(const Line& line, Half side, const Place& a, const Place& b, double length) {
  const Place run = b - a;
  const double across = cross(line.direction, run);
  const double part = across != 0 ? std::clamp(cross(line.direction, line.start - a) / across, 0.0, 1.0) : 0.0;
  const Place hit = a + part * run;
  return {dot(hit - line.start, line.direction), side, part * length};
}

}  // namespace

Line in_frame_of(const PolyhedralSurface& surface, Line line, Half half) {
  while (line.half != half) {
    const HalfRecord& r = surface.record(line.half);
    line = mapped(line, next(line.half), [&](const Place& p) { return in_next(r, p); });
  }
  return line;
}

Exit leave_through(const PolyhedralSurface& surface, const Line& line, Half side) {
  const HalfRecord& r = surface.record(line.half);
  if (side == line.half) return crossing(line, side, {0, 0}, {r.length, 0}, r.length);
  return side == next(line.half) ? crossing(line, side, {r.length, 0}, apex(r), r.right)
                                 : crossing(line, side, apex(r), {0, 0}, r.left);
}

Exit leave_upwards(const PolyhedralSurface& surface, const Line& line) {
  const bool left = cross(apex(surface.record(line.half)) - line.start, line.direction) > 0;
  return leave_through(surface, line, left ? previous(line.half) : next(line.half));
}

Exit leave(const PolyhedralSurface& surface, const Line& line) {
  const HalfRecord& r = surface.record(line.half);
  const Place corner[] = {{0, 0}, {r.length, 0}, apex(r)};
  const Half side[] = {line.half, next(line.half), previous(line.half)};
  double soonest = std::numeric_limits<double>::infinity();
  int through = 0;
  for (int s = 0; s < 3; ++s) {
    const Place a = corner[s], run = corner[(s + 1) % 3] - a;
    const double outwards = cross(line.direction, run);
    if (outwards <= 1e-14 * norm(run)) continue;
    const double walked_length = cross(a - line.start, run) / outwards;
    if (walked_length >= soonest) continue;
    soonest = walked_length;
    through = s;
  }
  return leave_through(surface, line, side[through]);
}

Line cross_side(const PolyhedralSurface& surface, const Line& line, const Exit& exit) {
  // In the frame of the half-edge whose left side is the exit.
  const Line seen = in_frame_of(surface, line, next(exit.side));
  const HalfRecord& r = surface.record(seen.half);
  Line beyond = mapped(seen, r.beyond_left, [&](const Place& p) {
    const Place q = beyond_left(r, p);
    return r.mirrored & 1 ? Place{r.left - q[0], q[1]} : q;
  });
  beyond.walked_length = exit.walked_length;
  return beyond;
}

/// Where rounding puts the place outside the face, the result is the nearest point of its sides. In needles, the weights could
/// be far from those of any nearby point.
MeshPoint point_of(const PolyhedralSurface& surface, Half half, const Place& place) {
  const HalfRecord& r = surface.record(half);
  const double up = place[1] / r.apex_y, ahead = (place[0] - up * r.apex_x) / r.length;
  if (up >= 0 && ahead >= 0 && up + ahead <= 1) {
    MeshPoint point{half / 3, {}};
    point.barycentric[half % 3] = std::max(0.0, 1 - up - ahead);
    point.barycentric[next(half) % 3] = ahead;
    point.barycentric[previous(half) % 3] = up;
    return point;
  }
  const Place corner[] = {{0, 0}, {r.length, 0}, apex(r)};
  const Half side[] = {half, next(half), previous(half)};
  const double length[] = {r.length, r.right, r.left};
  double nearest = std::numeric_limits<double>::infinity(), along = 0;
  int on = 0;
  for (int s = 0; s < 3; ++s) {
    const Place run = (1 / length[s]) * (corner[(s + 1) % 3] - corner[s]);
    const double t = std::clamp(dot(place - corner[s], run), 0.0, length[s]);
    const double away = norm(place - (corner[s] + t * run));
    if (!(away < nearest)) continue;
    nearest = away;
    along = t;
    on = s;
  }
  return point_on(surface, side[on], along);
}

MeshPoint point_on(const PolyhedralSurface& surface, Half side, double along) {
  const double part = std::clamp(along / surface.record(side).length, 0.0, 1.0);
  MeshPoint point{side / 3, {0, 0, 0}};
  point.barycentric[side % 3] = 1 - part;
  point.barycentric[next(side) % 3] = part;
  return point;
}

Line line_from(Half half, const Place& place, double angle) {
  return {half, place, {std::cos(angle), std::sin(angle)}, 0};
}

Line line_from_vertex(const PolyhedralSurface& surface, Index vertex, double angle) {
  Corner c = surface.first_corner(vertex);
  for (;;) {
    const double width = surface.angle(c.half);
    const Corner left = surface.turn_left(c);
    if (angle <= width || left.half < 0 || left == surface.first_corner(vertex))
      return line_from(c.half, {0, 0}, std::clamp(c.forward ? angle : width - angle, 0.0, width));
    angle -= width;
    c = left;
  }
}

double angle_in_face(const PolyhedralSurface& surface, const Line& line) {
  const Line seen = in_frame_of(surface, line, 3 * (line.half / 3));
  return std::atan2(seen.direction[1], seen.direction[0]);
}

VertexAngle angle_at_vertex(const PolyhedralSurface& surface, Half corner, const Place& towards) {
  const double width = surface.angle(corner), within = std::clamp(std::atan2(towards[1], towards[0]), 0.0, width);
  double turned = 0;
  for (Corner c = surface.first_corner(surface.record(corner).tail);; c = surface.turn_left(c)) {
    if (c.half == corner) return {turned + (c.forward ? within : width - within), c.forward};
    turned += surface.angle(c.half);
  }
}

namespace {

using std::numbers::pi;

/// Crossings closer than this to an end of a straight piece, relative to its length, are that end.
constexpr double end_margin = 1e-11;
/// A line that leaves a face closer than this to a corner, relative to the side, passes through the vertex.
constexpr double vertex_margin = 1e-12, graze_margin = 1e-10;

double positive_angle(double angle) { return angle < 0 ? angle + 2 * pi : angle; }

/// Collects a path from its end back to its source.
class PathCollector {
 public:
  PathCollector(const PolyhedralSurface& surface, const ExactMap& map) : surface_(surface), map_(map) {}

  GeodesicPath to_vertex(Index vertex) {
    const Arrival& in = map_.arrival(Vertex{vertex});
    if (in.half >= 0) {
      const Half corner = previous(in.half);
      path_.end_direction = angle_at_vertex(surface_, corner, in_previous(surface_.record(in.half), in.from)).angle *
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
  /// Collects the path from a vertex back to the source, which is not added. -1: the path is already at its source.
  void back_from(Index vertex) {
    while (vertex >= 0 && map_.arrival(Vertex{vertex}).half >= 0) {
      path_.points.push_back(surface_.vertex_point(Vertex{vertex}));
      const Arrival& in = map_.arrival(Vertex{vertex});
      vertex = piece(in, apex(surface_.record(in.half)), map_.distance(Vertex{vertex}), nullptr);
    }
  }

  /// Adds the crossings of the straight piece that ends at a place of its last face, or at the apex.
  /// @param target  target at that place; null: the apex
  /// @return the vertex that the piece comes from, or the first vertex that it passes. Windows may cover both sides of the
  /// latter, within rounding, but only the arrival at the vertex itself determines which side is right. -1: a source that is
  /// not a vertex
  Index piece(const Arrival& in, const Place& end, double end_distance, const MeshPoint* target) {
    const Origin& origin = map_.origins()[in.origin];
    const Place back = in.from - end;
    const double length = norm(back);
    if (!(length > 0)) return origin.vertex;
    Line line{in.half, end, {back[0] / length, back[1] / length}};
    Exit exit = target ? leave(surface_, line) : leave_through(surface_, line, in.half);
    const auto at_end = [&] { return exit.walked_length >= (1 - end_margin) * length; };
    const auto with_source = [&] { return lies_in(map_.sources()[origin.source], line.half / 3); };
    const auto arrived = [&] {
      return at_end() && (origin.vertex >= 0 || with_source() || exit.walked_length > (1 + end_margin) * length);
    };
    while (!arrived()) {
      const Index through = grazed_vertex(exit, end_distance);
      if (through >= 0) return through;
      if (!(target && exit.walked_length <= end_margin * length && lies_on(*target, exit.side)))
        path_.points.push_back(point_on(surface_, exit.side, exit.along));
      const Line across = cross_side(surface_, line, exit);
      if (across.half < 0 && origin.vertex < 0 && (at_end() || with_source())) return -1;
      if (across.half < 0) return end_of_side(line, exit, end_distance);
      if (path_.points.size() > max_points()) lost(exit, end_distance);
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

  /// The vertex at an exit if the shortest path to it is part of this path; otherwise -1.
  Index grazed_vertex(const Exit& exit, double end_distance) const {
    const HalfRecord& r = surface_.record(exit.side);
    const bool at_tail = exit.along < graze_margin * r.length;
    if (!at_tail && exit.along < (1 - graze_margin) * r.length) return -1;
    const Index vertex = at_tail ? r.tail : r.head;
    return passes(vertex, exit.walked_length, end_distance) ? vertex : -1;
  }

  /// The vertex ahead, where a path along the boundary leaves it by rounding.
  Index end_of_side(const Line& line, const Exit& exit, double end_distance) const {
    const HalfRecord& r = surface_.record(exit.side);
    const bool to_head = in_frame_of(surface_, line, exit.side).direction[0] > 0;
    const Index vertex = to_head ? r.head : r.tail;
    const double walked_length = exit.walked_length + (to_head ? r.length - exit.along : exit.along);
    if (!passes(vertex, walked_length, end_distance)) lost(exit, end_distance);
    return vertex;
  }

  /// Whether the shortest path to a vertex, which the path has reached backward, is part of this path.
  bool passes(Index vertex, double walked_length, double end_distance) const {
    const double left = map_.distance(Vertex{vertex});
    return left < end_distance && std::abs(left + walked_length - end_distance) <= 1e-9 * end_distance;
  }

  [[noreturn]] static void lost(const Exit& exit, double end_distance) {
    throw Error("a path of length " + detail::number(end_distance) + " could not be traced beyond face " +
                std::to_string(exit.side / 3));
  }

  std::size_t max_points() const { return 3 * static_cast<std::size_t>(surface_.face_count()) + 3; }

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

/// Directions beyond the boundary by less than this run along it.
constexpr double boundary_margin = 1e-9;
/// Maximum number of sides that a line may cross.
constexpr std::size_t max_crossings = 1000000;

GeodesicPath without_points(Status status) {
  GeodesicPath path;
  path.status = status;
  return path;
}

/// Traces a straightest geodesic.
class Tracer {
 public:
  Tracer(const PolyhedralSurface& surface, double length) : surface_(surface), length_(length), left_(length) {}

  TracedPath from(const MeshPoint& start, Line line) {
    path_.points.push_back(start);
    const bool at_vertex = vertex_of(surface_, start) >= 0;
    for (Exit exit = at_vertex ? leave_corner(line) : leave(surface_, line);;) {
      if (left_ <= exit.walked_length)
        return end(TraceEnd::complete, line, left_, point_of(surface_, line.half, line.at(left_)));
      const double side = surface_.record(exit.side).length;
      const bool at_tail = exit.along<vertex_margin * side, at_head = exit.along>(1 - vertex_margin) * side;
      if (at_tail || at_head) {
        const Half corner = at_tail ? exit.side : next(exit.side);
        const Index vertex = surface_.record(corner).tail;
        const std::optional<double> out = outgoing_angle(line, corner);
        if (!out) return end(TraceEnd::boundary, line, exit.walked_length, surface_.vertex_point(Vertex{vertex}));
        done_ += exit.walked_length;
        left_ -= exit.walked_length;
        path_.points.push_back(surface_.vertex_point(Vertex{vertex}));
        line = line_from_vertex(surface_, vertex, *out);
        check_count(done_);
        exit = leave_corner(line);
        continue;
      }
      const Line beyond = cross_side(surface_, line, exit);
      const MeshPoint crossed = point_on(surface_, exit.side, exit.along);
      if (beyond.half < 0) return end(TraceEnd::boundary, line, exit.walked_length, crossed);
      path_.points.push_back(crossed);
      check_count(done_ + exit.walked_length);
      line = beyond;
      exit = leave_upwards(surface_, line);
    }
  }

 private:
  TracedPath end(TraceEnd how, const Line& line, double walked_length, const MeshPoint& point) {
    path_.end = how;
    path_.length = done_ + walked_length;
    path_.direction = positive_angle(angle_in_face(surface_, line));
    path_.points.push_back(point);
    return std::move(path_);
  }

  void check_count(double walked_length) const {
    if (path_.points.size() < max_crossings) return;
    throw InvalidArgument("line_too_long",
                          "the line crosses more than " + detail::counted(max_crossings, "side") + " within " +
                              detail::number(walked_length) + " of its length " + detail::number(length_) +
                              ", near face " + std::to_string(path_.points.back().face),
                          "choose a smaller length, or repair the needle triangles there");
  }

  /// Leaves the face through the side opposite to the corner where the line starts.
  Exit leave_corner(const Line& line) const { return leave_through(surface_, line, next(line.half)); }

  /// The angle at which a line continues at the vertex of a corner. At interior vertices half of the angle lies on either side.
  /// On the boundary pi lies on one side, or the line ends.
  std::optional<double> outgoing_angle(const Line& line, Half corner) const {
    const Index vertex = surface_.record(corner).tail;
    const Line seen = in_frame_of(surface_, line, corner);
    const double sum = surface_.angle_sum(vertex);
    const double in = angle_at_vertex(surface_, corner, -seen.direction).angle;
    if (!surface_.on_boundary(vertex)) return in < sum / 2 ? in + sum / 2 : in - sum / 2;
    if (in + pi <= sum + boundary_margin) return std::min(in + pi, sum);
    if (in - pi >= -boundary_margin) return std::max(in - pi, 0.0);
    return std::nullopt;
  }

  const PolyhedralSurface& surface_;
  double length_;
  double left_;      ///< remaining length, from the start of the current line
  double done_ = 0;  ///< length up to the start of the current line
  TracedPath path_;
};

}  // namespace

GeodesicPath path_to_vertex(const PolyhedralSurface& surface, const ExactMap& map, Vertex vertex) {
  if (vertex.index < 0 || vertex.index >= map.size() || map.size() != surface.vertex_count())
    throw InvalidArgument("vertex " + std::to_string(vertex.index) + " is outside [0, " + std::to_string(map.size()) +
                          "), or the map belongs to another surface");
  if (map.status(vertex) != Status::ok) return without_points(map.status(vertex));
  return PathCollector(surface, map).to_vertex(vertex.index);
}

GeodesicPath path_to_target(const PolyhedralSurface& surface, const ExactMap& map, std::size_t target) {
  if (target >= map.targets() || map.size() != surface.vertex_count())
    throw InvalidArgument("target " + std::to_string(target) + " is outside [0, " + std::to_string(map.targets()) +
                          "), or the map belongs to another surface");
  if (map.target_status(target) != Status::ok) return without_points(map.target_status(target));
  if (const Index vertex = vertex_of(surface, map.target(target)); vertex >= 0)
    return PathCollector(surface, map).to_vertex(vertex);
  return PathCollector(surface, map).to_target(target);
}

GeodesicPath geodesic_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to) {
  ExactOptions options;
  options.targets.push_back(to);
  options.only_targets = true;
  return path_to_target(surface, exact_map(surface, from, options), 0);
}

GeodesicPath geodesic_path(const PolyhedralSurface& surface, std::span<const MeshPoint> stops, bool closed) {
  if (stops.size() < 2)
    throw InvalidArgument("the number of 'stops' is " + std::to_string(stops.size()) + "; a path needs at least 2");
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
  if (!(length >= 0) || !std::isfinite(length)) throw InvalidArgument("length must be a finite number >= 0");
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
    angle = 0;  // along the first side, up to rounding
  if (angle < -boundary_margin || angle > sum + boundary_margin)
    throw InvalidArgument("the direction leaves the surface at vertex " + std::to_string(vertex) +
                          " of its boundary: its angle from the first side is " + detail::number(direction) +
                          ", the maximum is " + detail::number(sum));
  return Tracer(surface, length).from(surface.vertex_point(Vertex{vertex}), line_from_vertex(surface, vertex, angle));
}

namespace {

auto key(const MeshPoint& point) { return std::tie(point.face, point.barycentric); }

/// Groups the numbers of pairs that have the same start.
std::vector<std::vector<std::size_t>> group_by_start(std::span<const PointPair> pairs) {
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(pairs[a][0]) < key(pairs[b][0]); });
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || key(pairs[order[k - 1]][0]) != key(pairs[order[k]][0])) groups.emplace_back();
    groups.back().push_back(order[k]);
  }
  return groups;
}

}  // namespace

std::vector<GeodesicPath> geodesic_paths(const PolyhedralSurface& surface, std::span<const PointPair> pairs,
                                         const Progress& progress, unsigned threads) {
  const std::vector<std::vector<std::size_t>> groups = group_by_start(pairs);
  std::vector<GeodesicPath> paths(pairs.size());
  detail::Mutex reporting;
  std::size_t done = 0;
  detail::parallel_chunks(static_cast<Offset>(groups.size()), 1, threads, [&](Offset g, Offset) {
    const std::vector<std::size_t>& group = groups[static_cast<std::size_t>(g)];
    ExactOptions options;
    options.progress.stop = progress.stop;
    options.only_targets = true;
    for (std::size_t k : group) options.targets.push_back(pairs[k][1]);
    const ExactMap map = exact_map(surface, pairs[group.front()][0], options);
    for (std::size_t t = 0; t < group.size(); ++t) paths[group[t]] = path_to_target(surface, map, t);
    const detail::Lock lock(reporting);
    progress.step("paths", static_cast<double>(++done) / static_cast<double>(groups.size()));
  });
  return paths;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The last step of an edge path to a vertex.
struct Step {
  double distance = infinity;  ///< length of the path up to the vertex
  Index from = -1;             ///< previous vertex; -1: start of the path
  Half across = -1;            ///< half-edge that the step crosses; -1: none
  double along = 0;            ///< position of the crossing, from the tail of `across`
};

/// One step per vertex, in pages allocated on first access: searches between near points use little memory on large surfaces.
class Steps {
 public:
  explicit Steps(Index size) : pages_(static_cast<std::size_t>(size) / per_page + 1) {}
  Step& operator[](Index vertex) {
    std::unique_ptr<Page>& page = pages_[static_cast<std::size_t>(vertex) / per_page];
    if (!page) page = std::make_unique<Page>();
    return (*page)[static_cast<std::size_t>(vertex) % per_page];
  }

 private:
  static constexpr std::size_t per_page = 128;
  using Page = std::array<Step, per_page>;
  std::vector<std::unique_ptr<Page>> pages_;
};

/// The shortest path along the edges and straight across edges to the vertex beyond. By Dijkstra's algorithm or, with a lower
/// bound, A* [HNR68].
class EdgeSearch {
 public:
  EdgeSearch(const PolyhedralSurface& surface, const std::function<double(Vertex)>& at_least)
      : surface_(surface), at_least_(at_least), step_(surface.vertex_count()) {}

  /// The vertices of the path and its crossings of edges between them; empty where there is no path.
  std::vector<MeshPoint> run(const MeshPoint& from, const MeshPoint& to) {
    double after[3];
    for (int s = 0; s < 3; ++s) after[s] = to_corner(to, s);
    for (int s = 0; s < 3; ++s)
      if (const double d = to_corner(from, s); d < infinity) offer(surface_.record(3 * from.face + s).tail, {d});
    double best = infinity;
    Index last = -1;
    while (!queue_.empty() && queue_.top().key < best) {
      const Entry entry = queue_.top();
      queue_.pop();
      if (entry.distance > step_[entry.vertex].distance) continue;
      for (int s = 0; s < 3; ++s)
        if (surface_.record(3 * to.face + s).tail == entry.vertex && entry.distance + after[s] < best) {
          best = entry.distance + after[s];
          last = entry.vertex;
        }
      expand(entry);
    }
    std::vector<MeshPoint> way;
    for (Index v = last; v >= 0; v = step_[v].from) {
      way.push_back(surface_.vertex_point(Vertex(v)));
      if (step_[v].across >= 0) way.push_back(point_on(surface_, step_[v].across, step_[v].along));
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  struct Entry {
    double key, distance;
    Index vertex;
    bool operator<(const Entry& other) const { return key != other.key ? key > other.key : vertex > other.vertex; }
  };

  /// Distance from a point of a face to corner s. A point at a vertex reaches this vertex only.
  double to_corner(const MeshPoint& point, int s) const {
    if (vertex_of(surface_, point) >= 0) return point.barycentric[s] > 0 ? 0 : infinity;
    MeshPoint corner{point.face, {0, 0, 0}};
    corner.barycentric[s] = 1;
    return distance(surface_.place(point), surface_.place(corner));
  }

  void expand(const Entry& entry) {
    const Corner first = surface_.first_corner(entry.vertex);
    Corner c = first;
    do {
      const HalfRecord& r = surface_.record(c.half);
      offer(r.head, {entry.distance + r.length, entry.vertex});
      offer(r.apex, {entry.distance + r.left, entry.vertex});
      if (r.beyond_right >= 0) cross_right(entry, r);
      c = surface_.turn_left(c);
    } while (c.half >= 0 && c != first);
  }

  /// Offers a step to the vertex beyond the side opposite to the tail, if the straight line to it crosses that side.
  void cross_right(const Entry& entry, const HalfRecord& r) {
    const HalfRecord& there = surface_.record(r.beyond_right);
    Place from = beyond_right(r, {0, 0});
    if (r.mirrored & 2) from[0] = there.length - from[0];
    const Place to = apex(there);
    const double along = from[0] - (to[0] - from[0]) * from[1] / (to[1] - from[1]);
    if (along > 0 && along < there.length)
      offer(there.apex, {entry.distance + exact::distance(from, to), entry.vertex, r.beyond_right, along});
  }

  void offer(Index vertex, const Step& step) {
    Step& known = step_[vertex];
    if (!(step.distance < known.distance)) return;
    known = step;
    queue_.push({step.distance + (at_least_ ? at_least_(Vertex(vertex)) : 0.0), step.distance, vertex});
  }

  const PolyhedralSurface& surface_;
  const std::function<double(Vertex)>& at_least_;
  Steps step_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

GeodesicPath locally_shortest_path(const PolyhedralSurface& surface, const MeshPoint& from, const MeshPoint& to,
                                   const std::function<double(Vertex)>& at_least) {
  const MeshPoint start = checked(surface, from, "from"), end = checked(surface, to, "to");
  const Index start_vertex = vertex_of(surface, start), end_vertex = vertex_of(surface, end);
  std::vector<MeshPoint> curve{start};
  if (start.face == end.face) {
    curve.push_back(end);
    return shortened_path(surface, curve);
  }
  if (surface.component(start) != surface.component(end)) {
    GeodesicPath none;
    none.status = Status::disconnected;
    return none;
  }
  for (const MeshPoint& p : EdgeSearch(surface, at_least).run(start, end))
    if (const Index v = vertex_of(surface, p); v < 0 || (v != start_vertex && v != end_vertex)) curve.push_back(p);
  curve.push_back(end);
  Strip strip = strip_along(surface, curve);
  const TautLine line = pass_other_side(surface, strip, shorten(surface, strip));
  return path_along(surface, strip, line);
}

}  // namespace ahm::exact
