#include "ahm/maps/tangent_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/types.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

/// A point of a tangent plane on a line, and the position of that plane when it is unfolded into the first plane of the line.
struct Walker {
  Index vertex = 0;
  Vec2 at{};                                   ///< position in the tangent plane of the vertex, graph units
  Vec2 origin{};                               ///< origin of this plane in the first plane
  std::array<Vec2, 2> axes{{{1, 0}, {0, 1}}};  ///< axes of this plane in the first plane

  Vec2 in_first(const Vec2& v) const { return v[0] * axes[0] + v[1] * axes[1]; }
  Vec2 from_first(const Vec2& v) const { return {dot(v, axes[0]), dot(v, axes[1])}; }

  /// Transports the point and a direction to the tangent plane of a neighbor.
  void go_over(const Star& star, std::size_t edge, Vec2& direction);
};

/// Where a line leaves the cell of its vertex: the distance to the exit, infinite if the line does not leave it, and the edge to the
/// next cell.
struct Exit {
  double way = std::numeric_limits<double>::infinity();
  std::size_t edge = 0;
};
/// Finds the first exit of a line.
/// @param direction  unit vector
/// @param least      smallest distance of an exit
Exit exit_of(const Star& star, const Vec2& at, const Vec2& direction, double least = 0);

/// Whether a point lies beyond the boundary: between two successive neighbors more than 120 degrees apart, farther away than both.
bool is_beyond(const Star& star, const Vec2& point);

/// A line over tangent planes, graph units.
struct Track {
  std::vector<Walker> walkers;  ///< start, exits from cells, end
  double length = 0;
  bool complete = true;
  Vec2 arrival{};  ///< direction at the last walker
};

/// Traces a straight line up to `length` or the boundary. @param direction  unit vector
Track follow(const TangentGraph& graph, Walker walker, Vec2 direction, double length);

/// The components of e_ij.
inline Vec2 log_of(const Star& star, std::size_t edge) { return {star.log(edge)[0], star.log(edge)[1]}; }

namespace {

/// Number of successive cells without progress after which a line is assumed to circle around a corner where cells meet.
constexpr int most_idle_cells = 20;

}  // namespace

void Walker::go_over(const Star& star, std::size_t edge, Vec2& direction) {
  const Transport R = star.transport(edge);
  const Vec2 log = log_of(star, edge), here = at - log, before = direction;
  R.apply_inverse(here.data(), at.data());
  R.apply_inverse(before.data(), direction.data());
  origin = origin + in_first(log);
  std::array<Vec2, 2> carried;
  for (std::size_t a = 0; a < 2; ++a) {
    const Vec2 axis{a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0};
    Vec2 image{};
    R.apply(axis.data(), image.data());
    carried[a] = in_first(image);
  }
  axes = carried;
  vertex = star.neighbors[edge];
}

Exit exit_of(const Star& star, const Vec2& at, const Vec2& direction, double least) {
  Exit exit;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log = log_of(star, e);
    const double towards = dot(direction, log);
    if (!(towards > 0)) continue;
    const double way = std::max(0.0, (0.5 * dot(log, log) - dot(at, log)) / towards);
    if (way >= least && way < exit.way) exit = {way, e};
  }
  return exit;
}

bool is_beyond(const Star& star, const Vec2& point) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double right = -infinity, left = infinity, right_reach = 0, left_reach = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 log = log_of(star, e);
    const double turn = std::atan2(cross(point, log), dot(point, log)), size = std::hypot(log[0], log[1]);
    const double behind = turn > 0 ? turn - 2 * std::numbers::pi : turn,
                 ahead = turn > 0 ? turn : turn + 2 * std::numbers::pi;
    if (behind > right) right = behind, right_reach = size;
    if (ahead < left) left = ahead, left_reach = size;
  }
  const double reach = std::max(right_reach, left_reach);
  return left - right > 2 * std::numbers::pi / 3 && std::hypot(point[0], point[1]) > reach;
}

Track follow(const TangentGraph& graph, Walker walker, Vec2 direction, double length) {
  Track track;
  track.walkers.push_back(walker);
  int idle = 0;
  const double least_way = 1e-6 * graph.mean_edge_length();
  while (true) {
    const Star star = graph.star(walker.vertex);
    const double rest = length - track.length;
    const double least = idle > most_idle_cells ? std::ldexp(least_way, idle - most_idle_cells) : 0.0;
    const Exit exit = exit_of(star, walker.at, direction, least);
    const double way = std::min(rest, exit.way);
    const Vec2 there = walker.at + way * direction;
    if (is_beyond(star, there)) {
      const double last = std::clamp(-dot(walker.at, direction), 0.0, way);
      walker.at = walker.at + last * direction;
      track.length += last;
      track.complete = last >= rest;
      break;
    }
    walker.at = there;
    track.length += way;
    if (way >= rest) break;
    idle = way > least_way ? 0 : idle + 1;
    track.walkers.push_back(walker);
    walker.go_over(star, exit.edge, direction);
  }
  track.walkers.push_back(walker);
  track.arrival = direction;
  return track;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Largest number of shots to straighten a path.
constexpr int most_shots = 60;

void check(const TangentGraph& graph, const char* what, const TangentPlanePoint& place) {
  if (graph.dimension() != 2)
    throw InvalidArgument("lines over tangent planes require dimension 2; the graph has dimension " +
                          std::to_string(graph.dimension()));
  if (place.vertex.index < 0 || place.vertex.index >= graph.size())
    throw InvalidArgument(std::string(what) + ": vertex " + std::to_string(place.vertex.index) + " is outside [0, " +
                          std::to_string(graph.size()) + ")");
  if (!all_finite(place.offset)) throw InvalidArgument(std::string(what) + ": the offset is not finite");
}

Vec2 unit(const Vec2& v) {
  const double size = std::hypot(v[0], v[1]);
  return size > 0 ? 1 / size * v : Vec2{0, 0};
}

TangentLine in_world_units(const Track& track, double length_unit) {
  TangentLine line;
  for (const Walker& walker : track.walkers) line.places.push_back({Vertex(walker.vertex), length_unit * walker.at});
  line.length = track.length * length_unit;
  line.complete = track.complete;
  line.arrival = track.arrival;
  return line;
}

/// Position of `to` in the tangent plane of a vertex; nullopt unless `to` belongs to the vertex or one of its neighbors.
std::optional<Vec2> seen_from(const TangentGraph& graph, Index vertex, const TangentPlanePoint& to) {
  if (vertex == to.vertex.index) return to.offset;
  const Star star = graph.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.neighbors[e] == to.vertex.index) {
      Vec2 offset{};
      star.transport(e).apply(to.offset.data(), offset.data());
      return log_of(star, e) + offset;
    }
  return std::nullopt;
}

/// Follows the distances of a front back to the point where it started.
class Descent {
 public:
  Descent(const TangentGraph& graph, const TangentPlanePoint& to) : graph_(graph), to_(to), front_(graph) {
    Source source(2);
    const double identity[] = {1, 0, 0, 1};
    const Vec2 back = -graph.length_unit() * to.offset;
    source.add(to.vertex, 1.0, back, identity);
    front_.add(source);
  }

  /// Advances the front to a vertex. @return whether it reaches the vertex
  bool reaches(Vertex vertex) {
    for (double radius = 8 * graph_.mean_edge_length() * graph_.length_unit(); !(front_.distance(vertex) < infinity);
         radius *= 2) {
      front_.run(radius);
      if (front_.distance(vertex) < infinity) break;
      if (!(radius < infinity)) return false;
    }
    front_.run(front_.distance(vertex));
    return true;
  }

  Track track(Walker walker) {
    Track track;
    std::unordered_set<Index> left;
    track.walkers.push_back(walker);
    while (true) {
      if (const std::optional<Vec2> end = seen_from(graph_, walker.vertex, to_)) {
        walker.at = *end;
        track.walkers.push_back(walker);
        return track;
      }
      left.insert(walker.vertex);
      const std::optional<Onward> onward = straight_on(walker, left);
      if (!onward) find_ways_over_edges();
      const Star star = graph_.star(walker.vertex);
      const std::size_t edge = onward ? onward->edge : least(star, over_edges_);
      walker.at = onward ? walker.at + onward->way * onward->direction : log_of(star, edge);
      track.walkers.push_back(walker);
      Vec2 unused{};
      walker.go_over(star, edge, unused);
    }
  }

 private:
  double distance(Index vertex) const { return front_.distance(Vertex(vertex)) / graph_.length_unit(); }

  struct Onward {
    std::size_t edge;
    double way;
    Vec2 direction;
  };
  /// One straight step towards the point where the front started. nullopt if it would return to a cell in `left` or leave the
  /// surface, as at corners and in noise.
  std::optional<Onward> straight_on(const Walker& walker, const std::unordered_set<Index>& left) const {
    const Star star = graph_.star(walker.vertex);
    const Vec2 direction = unit(target(star, walker.vertex) - walker.at);
    const Exit exit = exit_of(star, walker.at, direction);
    if (!(exit.way < infinity) || is_beyond(star, walker.at + exit.way * direction) ||
        left.contains(star.neighbors[exit.edge]))
      return std::nullopt;
    return Onward{exit.edge, exit.way, direction};
  }

  /// Computes the lengths of the shortest edge paths to `to_`, which exist from all connected vertices.
  void find_ways_over_edges() {
    if (!over_edges_.empty()) return;
    over_edges_.assign(static_cast<std::size_t>(graph_.size()), infinity);
    ShortestPaths<double, std::vector<double>> paths(over_edges_, infinity);
    paths.offer(to_.vertex.index, 0);
    paths.run([&](Index i, double so_far) {
      const Star star = graph_.star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) paths.offer(star.neighbors[e], so_far + length(star.log(e)));
    });
  }

  /// The edge to the neighbor with the smallest value.
  static std::size_t least(const Star& star, const std::vector<double>& values) {
    std::size_t best = 0;
    for (std::size_t e = 1; e < star.degree(); ++e)
      if (values[star.neighbors[e]] < values[star.neighbors[best]]) best = e;
    return best;
  }

  /// The point where the front started, in the tangent plane of a vertex. It is computed from the distances of the vertex and of two
  /// successive neighbors that have the point between them. Of several pairs the one counts whose point fits best the distance of the
  /// vertex. Without such a pair it is the neighbor with the smallest distance.
  Vec2 target(const Star& star, Index vertex) const {
    const double own = distance(vertex);
    std::size_t nearest = 0;
    for (std::size_t e = 1; e < star.degree(); ++e)
      if (distance(star.neighbors[e]) < distance(star.neighbors[nearest])) nearest = e;
    std::vector<std::pair<double, std::size_t>> around;
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (distance(star.neighbors[e]) < infinity) around.emplace_back(std::atan2(star.log(e)[1], star.log(e)[0]), e);
    std::sort(around.begin(), around.end());
    Vec2 best = log_of(star, nearest);
    double least = 0.5;
    for (std::size_t k = 0; k < around.size(); ++k) {
      const std::size_t right = around[k].second, left = around[(k + 1) % around.size()].second;
      const Vec2 r = log_of(star, right), l = log_of(star, left);
      const double area = cross(r, l);
      if (!(area > 0)) continue;
      const auto share = [&](const Vec2& log, double there) {
        return 0.5 * (dot(log, log) + (own - there) * (own + there));
      };
      const double a = share(r, distance(star.neighbors[right])), b = share(l, distance(star.neighbors[left]));
      const Vec2 place{(a * l[1] - b * r[1]) / area, (b * r[0] - a * l[0]) / area};
      if (cross(r, place) < 0 || cross(place, l) < 0) continue;
      const double off = std::abs(std::hypot(place[0], place[1]) / own - 1);
      if (off < least) least = off, best = place;
    }
    return best;
  }

  const TangentGraph& graph_;
  TangentPlanePoint to_;  ///< graph units
  Wavefront front_;
  std::vector<double> over_edges_;  ///< lengths of the shortest edge paths to `to_`; empty until used
};

double length_of(const std::vector<Vec2>& unfolded) {
  double length = 0;
  for (std::size_t k = 1; k < unfolded.size(); ++k)
    length += std::hypot(unfolded[k][0] - unfolded[k - 1][0], unfolded[k][1] - unfolded[k - 1][1]);
  return length;
}

std::vector<Vec2> unfolded(const Track& track) {
  std::vector<Vec2> points;
  for (const Walker& walker : track.walkers) points.push_back(walker.origin + walker.in_first(walker.at));
  return points;
}

/// The straight line from the start of a track to `to`, found by shooting. The first shot aims at the end of the unfolded track. Each
/// following shot is corrected by the miss of the one before. The remaining miss is distributed over the line. nullopt if the shots do not
/// come near.
std::optional<Track> straightened(const TangentGraph& graph, const Track& track, const TangentPlanePoint& to) {
  const Walker& start = track.walkers.front();
  Vec2 mark = unfolded(track).back();
  std::optional<Track> best;
  Vec2 best_miss{};
  double least = graph.mean_edge_length();
  for (int shot = 0; shot < most_shots; ++shot) {
    const Vec2 way = mark - start.at;
    Track line = follow(graph, start, unit(way), std::hypot(way[0], way[1]));
    const Walker& end = line.walkers.back();
    const std::optional<Vec2> seen = seen_from(graph, end.vertex, to);
    if (!line.complete || !seen) break;
    const Vec2 miss = end.in_first(*seen - end.at);
    const double size = std::hypot(miss[0], miss[1]);
    if (!(size < least)) break;
    least = size, best_miss = miss, best = std::move(line);
    mark = mark + miss;
    if (size <= 1e-14 * best->length) break;
  }
  if (!best || !(best->length > 0)) return best;
  const std::vector<Vec2> before = unfolded(*best);
  double passed = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (k > 0) passed += std::hypot(before[k][0] - before[k - 1][0], before[k][1] - before[k - 1][1]);
    Walker& walker = best->walkers[k];
    walker.at = walker.at + walker.from_first(passed / best->length * best_miss);
  }
  return best;
}

/// The path that is found from `from` along the distances of a front from `to`.
TangentLine one_way(const TangentGraph& graph, const TangentPlanePoint& from, const TangentPlanePoint& to) {
  const double world = graph.length_unit();
  const TangentPlanePoint end{to.vertex, 1 / world * to.offset};
  Descent descent(graph, end);
  if (!descent.reaches(from.vertex)) return {.status = Status::disconnected, .places = {}};
  Track track = descent.track({.vertex = from.vertex.index, .at = 1 / world * from.offset});
  track.length = length_of(unfolded(track));
  if (std::optional<Track> line = straightened(graph, track, end)) {
    line->length = length_of(unfolded(*line));
    if (line->length <= track.length * (1 + 1e-9)) track = std::move(*line);
  }
  const std::vector<Vec2> points = unfolded(track);
  const auto differs = [](const Vec2& a, const Vec2& b) { return a != b; };
  Vec2 departure{}, arrival{};
  for (std::size_t k = 1; k < points.size() && departure == Vec2{}; ++k)
    if (differs(points[k], points[0])) departure = unit(points[k] - points[0]);
  for (std::size_t k = points.size() - 1; k > 0 && arrival == Vec2{}; --k)
    if (differs(points[k - 1], points.back())) arrival = unit(points.back() - points[k - 1]);
  track.arrival = track.walkers.back().from_first(arrival);
  TangentLine line = in_world_units(track, world);
  line.departure = departure;
  return line;
}

}  // namespace

TangentLine trace_line(const TangentGraph& graph, const TangentPlanePoint& from, const Vec2& direction, double length) {
  check(graph, "from", from);
  if (!all_finite(direction) || (direction[0] == 0 && direction[1] == 0))
    throw InvalidArgument("direction must be a finite vector that is not zero");
  if (!(length >= 0) || !std::isfinite(length)) throw InvalidArgument("length must be a finite number >= 0");
  const double world = graph.length_unit();
  const Vec2 along = unit(1 / largest(direction) * direction);
  TangentLine line = in_world_units(
      follow(graph, {.vertex = from.vertex.index, .at = 1 / world * from.offset}, along, length / world), world);
  line.departure = along;
  return line;
}

TangentLine shortest_line(const TangentGraph& graph, const TangentPlanePoint& from, const TangentPlanePoint& to) {
  check(graph, "from", from);
  check(graph, "to", to);
  TangentLine there = one_way(graph, from, to);
  if (there.status != Status::ok) return there;
  TangentLine back = one_way(graph, to, from);
  const auto preferred = [](const TangentPlanePoint& a, const TangentPlanePoint& b) {
    return std::pair(a.vertex, a.offset) <= std::pair(b.vertex, b.offset);
  };
  if (there.length != back.length ? there.length < back.length : preferred(from, to)) return there;
  std::reverse(back.places.begin(), back.places.end());
  std::swap(back.departure, back.arrival);
  back.departure = -back.departure, back.arrival = -back.arrival;
  return back;
}

namespace {

std::size_t main_sample(const Source& source) {
  if (source.is_curve()) throw InvalidArgument("'source' is a curve; a point is required");
  if (source.dimension().value_or(2) != 2)
    throw InvalidArgument("'source' has dimension " + std::to_string(*source.dimension()) + ", not 2");
  if (source.vertices().empty()) throw InvalidArgument("'source' has no vertices");
  return static_cast<std::size_t>(std::max_element(source.weights().begin(), source.weights().end()) -
                                  source.weights().begin());
}

}  // namespace

TangentPlanePoint tangent_plane_point(const Source& source) {
  const std::size_t k = main_sample(source);
  TangentPlanePoint place{source.vertices()[k]};
  if (source.offsets().empty()) return place;
  const std::span<const double> z = source.offsets().subspan(2 * k, 2), U = source.axes().subspan(4 * k, 4);
  for (std::size_t c = 0; c < 2; ++c) place.offset[c] = -(U[2 * c] * z[0] + U[2 * c + 1] * z[1]);
  return place;
}

Vec2 u_axis_at_point(const Source& source) {
  const std::size_t k = main_sample(source);
  if (source.axes().empty()) return {1, 0};
  return {source.axes()[4 * k], source.axes()[4 * k + 2]};
}

std::optional<Vec3> position(const TangentGraph& graph, const TangentPlanePoint& place) {
  const std::optional<Frame> frame = graph.frame(place.vertex.index);
  if (!frame) return std::nullopt;
  return frame->origin + place.offset[0] * frame->x + place.offset[1] * frame->y;
}

std::optional<Vec3> smooth_position(const TangentGraph& graph, const TangentPlanePoint& place) {
  std::optional<Vec3> own = position(graph, place);
  if (!own) return std::nullopt;
  const double world = graph.length_unit();
  const Star star = graph.star(place.vertex.index);
  double nearest = infinity;  // distance of the nearest neighbor
  for (std::size_t e = 0; e < star.degree(); ++e) nearest = std::min(nearest, length(star.log(e)));
  const auto exponent = [&](const Vec2& from_vertex) {
    return -2 * dot(from_vertex, from_vertex) / (nearest * nearest);
  };
  const Vec2 at = 1 / world * place.offset;
  std::vector<std::pair<TangentPlanePoint, double>> seen{{place, exponent(at)}};  // `position` may invalidate the star
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Vec2 from_vertex = at - log_of(star, e);
    Vec2 offset{};
    star.transport(e).apply_inverse(from_vertex.data(), offset.data());
    seen.push_back({{Vertex(star.neighbors[e]), world * offset}, exponent(from_vertex)});
  }
  // The largest weight is scaled to 1, so that no relevant weight underflows, however near the nearest neighbor is.
  const double largest = std::ranges::max_element(seen, {}, [](const auto& one) { return one.second; })->second;
  Vec3 sum{};
  double weights = 0;
  for (const auto& [from, power] : seen) {
    const double weight = std::exp(power - largest);
    sum = sum + weight * *position(graph, from), weights += weight;
  }
  return 1 / weights * sum;
}

}  // namespace ahm
