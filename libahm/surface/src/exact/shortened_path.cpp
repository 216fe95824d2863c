#include "exact/shortened_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "exact/geodesic_path.hpp"

namespace ahm::exact {
namespace {

/// The corner of a face at a vertex; -1: none.
Half corner_at(const PolyhedralSurface& surface, Index face, Index vertex) {
  for (Half h = 3 * face; h < 3 * face + 3; ++h)
    if (surface.record(h).tail == vertex) return h;
  return -1;
}

/// A point of a curve: a vertex, a point on a side, or a point inside a face.
struct Spot {
  MeshPoint point;
  Index vertex = -1;
  Half side = -1;

  Spot(const PolyhedralSurface& surface, const MeshPoint& p, std::size_t number)
      : point(checked(surface, p, "point " + std::to_string(number) + " of the curve")),
        vertex(vertex_of(surface, point)) {
    for (int s = 0; s < 3 && vertex < 0; ++s)
      if (point.barycentric[s] == 0) side = 3 * point.face + (s + 1) % 3;
  }

  bool lies_in(const PolyhedralSurface& surface, Index face) const {
    if (vertex >= 0) return corner_at(surface, face, vertex) >= 0;
    if (point.face == face) return true;
    const Half other = side < 0 ? -1 : beyond(surface, side);
    return other >= 0 && other / 3 == face;
  }

  CurveEnd in_face(const PolyhedralSurface& surface, Index face) const {
    CurveEnd end{point, vertex < 0 ? -1 : corner_at(surface, face, vertex)};
    if (point.face == face) return end;
    const Half there = vertex >= 0 ? end.corner : beyond(surface, side);
    end.point = {face, {0, 0, 0}};
    if (vertex >= 0) {
      end.point.barycentric[there % 3] = 1;
    } else {
      const bool same = mirrored_beyond(surface, side);
      end.point.barycentric[there % 3] = point.barycentric[(same ? side : next(side)) % 3];
      end.point.barycentric[next(there) % 3] = point.barycentric[(same ? next(side) : side) % 3];
    }
    return end;
  }
};

/// The faces around a vertex in one direction, up to one that contains a point.
struct Search {
  std::vector<Half> entered;
  Half corner = -1;  ///< corner of the face that contains the point; -1: none
  double angle = 0;  ///< sum of the angles of the faces in between

  Search(const PolyhedralSurface& surface, Half from, const Spot& wanted, bool left) {
    Corner c{from, true};
    for (bool first = true;; first = false) {
      if (wanted.lies_in(surface, c.half / 3)) {
        corner = c.half;
        return;
      }
      if (!first) angle += surface.angle(c.half);
      c = left ? surface.turn_left(c) : surface.turn_right(c);
      if (c.half < 0 || c.half == from) return;
      entered.push_back(left == c.forward ? c.half : previous(c.half));
    }
  }
};

[[noreturn]] void refuse(std::size_t number) {
  throw InvalidArgument("points " + std::to_string(number) + " and " + std::to_string(number + 1) +
                        " of the curve have no common face");
}

}  // namespace

Place to_first_side(const PolyhedralSurface& surface, Half half, const Place& p) {
  const HalfRecord& r = surface.record(half);
  return half % 3 == 0 ? p : half % 3 == 1 ? in_previous(r, p) : in_next(r, p);
}

Place from_first_side(const PolyhedralSurface& surface, Half half, const Place& p) {
  const HalfRecord& r = surface.record(3 * (half / 3));
  return half % 3 == 0 ? p : half % 3 == 1 ? in_next(r, p) : in_previous(r, p);
}

void enter(const PolyhedralSurface& surface, std::vector<Half>& entered, Half half) {
  if (!entered.empty() && entered.back() == beyond(surface, half))
    entered.pop_back();
  else
    entered.push_back(half);
}

void trim(const PolyhedralSurface& surface, Strip& strip) {
  const auto touches = [](Half side, Half corner) { return side == corner || next(side) == corner; };
  const auto move_over = [&](CurveEnd& end, Half side) {
    const Corner here{end.corner, true};
    end.corner = (side == end.corner ? surface.turn_right(here) : surface.turn_left(here)).half;
    end.point = {end.corner / 3, {0, 0, 0}};
    end.point.barycentric[end.corner % 3] = 1;
  };
  std::size_t first = 0;
  for (; strip.start.corner >= 0 && first < strip.entered.size(); ++first) {
    const Half side = beyond(surface, strip.entered[first]);
    if (!touches(side, strip.start.corner)) break;
    move_over(strip.start, side);
  }
  strip.entered.erase(strip.entered.begin(), strip.entered.begin() + static_cast<std::ptrdiff_t>(first));
  while (strip.end.corner >= 0 && !strip.entered.empty() && touches(strip.entered.back(), strip.end.corner)) {
    move_over(strip.end, strip.entered.back());
    strip.entered.pop_back();
  }
}

std::optional<std::vector<Half>> turn(const PolyhedralSurface& surface, Half from, Half to, bool left) {
  std::vector<Half> entered;
  for (Corner c{from, true}; c.half != to;) {
    c = left ? surface.turn_left(c) : surface.turn_right(c);
    if (c.half < 0) return std::nullopt;
    entered.push_back(left == c.forward ? c.half : previous(c.half));
  }
  return entered;
}

Strip strip_along(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) {
  if (curve.size() < 2) throw InvalidArgument("a curve needs at least 2 points");
  Strip strip;
  Spot at(surface, curve[0], 0);
  Index face = -1;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const Spot to(surface, curve[k + 1], k + 1);
    Half into = -1;
    if (at.vertex >= 0) {
      const Half from = face < 0 ? surface.first_corner(at.vertex).half : corner_at(surface, face, at.vertex);
      Search left(surface, from, to, true), right(surface, from, to, false);
      if (left.corner < 0 && right.corner < 0) refuse(k);
      const bool is_left = right.corner < 0 || (left.corner >= 0 && left.angle <= right.angle);
      const Search& found = is_left ? left : right;
      if (face >= 0)
        for (Half h : found.entered) enter(surface, strip.entered, h);
      face = found.corner / 3;
    } else if (face < 0 || !to.lies_in(surface, face)) {
      if (face < 0 && to.lies_in(surface, at.point.face)) {
        face = at.point.face;
      } else {
        const Index here = face < 0 ? at.point.face : face;
        for (Half side : {at.side, at.side < 0 ? -1 : beyond(surface, at.side)})
          if (side >= 0 && side / 3 != here && to.lies_in(surface, side / 3)) into = side;
        if (into < 0) refuse(k);
        if (face >= 0) enter(surface, strip.entered, into);
        face = into / 3;
      }
    }
    if (k == 0) strip.start = at.in_face(surface, face);
    at = to;
  }
  strip.end = at.in_face(surface, face);
  return strip;
}

namespace {

/// A line that passes a vertex at a smaller angle than this bends there, so that its other side is considered.
constexpr double touch_angle = 1e-12;

Place turned_left(const Place& v) { return {-v[1], v[0]}; }

/// The side through which a face is left, in the frame of side 0. Seen from inside the face, its head is on the left.
Portal first_portal(const PolyhedralSurface& surface, Half side, bool mirrored) {
  const HalfRecord& r = surface.record(side);
  return {to_first_side(surface, side, {r.length, 0}), to_first_side(surface, side, {0, 0}), !mirrored};
}

/// The unfolded frame of a half-edge that enters a face.
struct UnfoldedFrame {
  Place tail, along, up;

  UnfoldedFrame(const Portal& portal) : tail(portal.tail_left ? portal.left : portal.right) {
    const Place across = portal.right - portal.left;
    const Place unit = (1 / norm(across)) * across;
    along = portal.tail_left ? unit : -unit;
    up = turned_left(unit);
  }
  Place out_of(const Place& p) const { return tail + p[0] * along + p[1] * up; }
  Place into(const Place& p) const { return {dot(p - tail, along), dot(p - tail, up)}; }
};

/// The next portal: one end stays, the other one is the apex.
Portal next_portal(const PolyhedralSurface& surface, const Portal& portal, Half entered, Half side) {
  const Place top = UnfoldedFrame(portal).out_of(apex(surface.record(entered)));
  const bool keeps_tail = side == previous(entered), forward = portal.tail_left;
  const bool tail_left = forward != mirrored_beyond(surface, side);
  return keeps_tail == forward ? Portal{portal.left, top, tail_left} : Portal{top, portal.right, tail_left};
}

std::vector<Portal> unfold(const PolyhedralSurface& surface, const Strip& strip) {
  std::vector<Portal> portals;
  portals.reserve(strip.entered.size());
  for (std::size_t k = 0; k < strip.entered.size(); ++k) {
    const Half side = beyond(surface, strip.entered[k]);
    portals.push_back(k == 0 ? first_portal(surface, side, mirrored_beyond(surface, side))
                             : next_portal(surface, portals.back(), strip.entered[k - 1], side));
  }
  return portals;
}

/// The funnel: two chains that bend outward, from an apex to the ends of the last portal.
class Funnel {
 public:
  explicit Funnel(const Place& start) : left_{0}, right_{0} { nodes_.push_back({start, -1, false, 0, 0}); }

  /// Adds an end of a portal that differs from the one before on this side.
  void add(const Place& at, bool left, std::size_t portal) {
    auto& own = left ? left_ : right_;
    auto& other = left ? right_ : left_;
    auto& own_apex = left ? left_apex_ : right_apex_;
    auto& other_apex = left ? right_apex_ : left_apex_;
    const double sign = left ? 1 : -1;
    // `turn`: sine of the outward turn at b of the line from a to b to `at`. `is_ahead` decides where it is near zero.
    const auto turn = [&](std::size_t a, std::size_t b) {
      const Vec2 to_b = nodes_[b].at - nodes_[a].at, on = at - nodes_[b].at;
      return sign * cross(to_b, on) / (norm(to_b) * norm(on));
    };
    const auto is_ahead = [&](std::size_t a, std::size_t b) {
      return dot(nodes_[b].at - nodes_[a].at, at - nodes_[a].at) > 0;
    };
    while (own.size() - own_apex > 1) {
      const std::size_t a = own[own.size() - 2], b = own.back();
      const double sine = turn(a, b);
      const bool beyond_b = dot(nodes_[b].at - nodes_[a].at, at - nodes_[b].at) > 0;
      if (sine > touch_angle || (sine > -touch_angle && beyond_b)) break;
      own.pop_back();
    }
    if (own.size() - own_apex == 1) {
      // The new end may lie beyond the other chain, except where the start lies between both ends of its portal.
      while (other.size() - other_apex > 1) {
        const std::size_t a = other[other_apex], b = other[other_apex + 1];
        const double sine = turn(a, b);
        if (sine > touch_angle || (sine > -touch_angle && !is_ahead(a, b))) break;
        ++other_apex;
        own.assign(1, b);
        own_apex = 0;
      }
    }
    nodes_.push_back({at, static_cast<std::ptrdiff_t>(own.back()), left, portal, portal});
    own.push_back(nodes_.size() - 1);
  }
  /// Records that a portal has the same end as the one before.
  void keep(bool left, std::size_t portal) { nodes_[latest_[left]].last = portal; }
  void set_latest(bool left) { latest_[left] = nodes_.size() - 1; }

  /// The bends from the start to the last added node.
  std::vector<Bend> bends() const {
    std::vector<std::size_t> chain;
    for (auto k = static_cast<std::ptrdiff_t>(nodes_.size()) - 1; k >= 0; k = nodes_[k].parent)
      chain.push_back(static_cast<std::size_t>(k));
    std::reverse(chain.begin(), chain.end());
    std::vector<Bend> result;
    for (std::size_t k : chain) result.push_back({nodes_[k].at, nodes_[k].left, nodes_[k].first, nodes_[k].last});
    // Where two bends are the ends of one portal, the line runs along the portal.
    for (std::size_t k = 1; k + 2 < result.size(); ++k) {
      Bend &a = result[k], &b = result[k + 1];
      if (a.left == b.left || a.leaves < b.arrives) continue;
      a.leaves = b.arrives = std::max(a.arrives, b.arrives);
    }
    return result;
  }

 private:
  struct Node {
    Place at;
    std::ptrdiff_t parent;
    bool left;
    std::size_t first, last;  ///< first and last portal that end here
  };
  std::vector<Node> nodes_;
  std::vector<std::size_t> left_, right_;  ///< chains; entries before the apex are already passed
  std::size_t left_apex_ = 0, right_apex_ = 0;
  std::size_t latest_[2] = {0, 0};
};

Place end_of(const PolyhedralSurface& surface, const Strip& strip, const std::vector<Portal>& portals) {
  const Place inside = surface.place(strip.end.point);
  if (portals.empty()) return inside;
  return UnfoldedFrame(portals.back()).out_of(from_first_side(surface, strip.entered.back(), inside));
}

}  // namespace

std::vector<double> TautLine::crossings() const {
  std::vector<double> share(portals.size(), 0);
  for (std::size_t k = 0; k + 1 < bends.size(); ++k) {
    const Bend &from = bends[k], &to = bends[k + 1];
    const std::size_t first = k == 0 ? 0 : from.leaves + 1, last = k + 2 == bends.size() ? portals.size() : to.arrives;
    for (std::size_t p = first; p < last; ++p) {
      const Place way = to.at - from.at;
      const double left = cross(way, portals[p].left - from.at), right = cross(way, portals[p].right - from.at);
      share[p] = left != right ? std::clamp(left / (left - right), 0.0, 1.0) : 0.5;
    }
    if (k + 2 == bends.size()) continue;
    for (std::size_t p = to.arrives; p <= to.leaves; ++p) share[p] = to.left ? 0 : 1;
  }
  return share;
}

TautLine pull_taut(const PolyhedralSurface& surface, const Strip& strip) {
  TautLine line;
  line.portals = unfold(surface, strip);
  Funnel funnel(surface.place(strip.start.point));
  for (std::size_t p = 0; p < line.portals.size(); ++p) {
    const Portal& portal = line.portals[p];
    for (const bool left : {true, false}) {
      const Place& at = left ? portal.left : portal.right;
      if (p > 0 && at == (left ? line.portals[p - 1].left : line.portals[p - 1].right)) {
        funnel.keep(left, p);
      } else {
        funnel.add(at, left, p);
        funnel.set_latest(left);
      }
    }
  }
  const Place end = end_of(surface, strip, line.portals);
  funnel.add(end, true, line.portals.size());
  line.bends = funnel.bends();
  for (std::size_t k = 1; k < line.bends.size(); ++k) line.length += distance(line.bends[k].at, line.bends[k - 1].at);
  line.arrival = line.bends[line.bends.size() - 2].at;
  if (!line.portals.empty())
    line.arrival = to_first_side(surface, strip.entered.back(), UnfoldedFrame(line.portals.back()).into(line.arrival));
  return line;
}

namespace {

using std::numbers::pi;

const Place& other_end(const Portal& portal, const Bend& bend) { return bend.left ? portal.right : portal.left; }

/// The angle at a bend, on the side of the strip.
double angle_in_strip(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line, std::size_t k) {
  const Bend& bend = line.bends[k];
  const auto to_edge = [&](const Bend& neighbor, std::size_t portal) {
    return angle_between(neighbor.at - bend.at, other_end(line.portals[portal], bend) - bend.at);
  };
  double sum = to_edge(line.bends[k - 1], bend.arrives) + to_edge(line.bends[k + 1], bend.leaves);
  for (std::size_t p = bend.arrives; p < bend.leaves; ++p) sum += surface.angle(corner_after(strip, line, bend, p));
  return sum;
}

/// Moves the strip to the other side of bends where the line is shorter there. Skips bends that overlap the one before.
/// @return whether there was such a bend
bool flip_bends(const PolyhedralSurface& surface, Strip& strip, const TautLine& line) {
  std::vector<Half> entered;
  std::size_t done = 0;
  for (std::size_t k = 1; k + 1 < line.bends.size(); ++k) {
    const Bend& bend = line.bends[k];
    if (bend.arrives < done) continue;
    const Index vertex = surface.record(corner_after(strip, line, bend, bend.arrives)).tail;
    if (!(surface.angle_sum(vertex) - angle_in_strip(surface, strip, line, k) < pi - straight_margin)) continue;
    const auto around = other_side(surface, strip, line, bend);
    if (!around) continue;
    for (; done < bend.arrives; ++done) enter(surface, entered, strip.entered[done]);
    for (Half h : *around) enter(surface, entered, h);
    done = bend.leaves + 1;
  }
  if (done == 0) return false;
  for (; done < strip.entered.size(); ++done) enter(surface, entered, strip.entered[done]);
  strip.entered = std::move(entered);
  return true;
}

/// The direction in which a line leaves an end, as in `ExactMap::direction`.
/// @param towards  next point of the line, in the frame of side 0 of the end's face
double direction_at(const PolyhedralSurface& surface, const CurveEnd& end, const Place& towards) {
  if (end.corner >= 0) {
    const Index vertex = surface.record(end.corner).tail;
    return angle_at_vertex(surface, end.corner, from_first_side(surface, end.corner, towards)).angle *
           surface.angle_scale(vertex);
  }
  const Vec2 way = towards - surface.place(end.point);
  const double angle = std::atan2(way[1], way[0]);
  return angle < 0 ? angle + 2 * pi : angle;
}

MeshPoint at_corner(Half corner) {
  MeshPoint point{corner / 3, {0, 0, 0}};
  point.barycentric[corner % 3] = 1;
  return point;
}

}  // namespace

std::optional<std::vector<Half>> other_side(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line,
                                            const Bend& bend) {
  const Half first = strip.entered[bend.arrives], side = beyond(surface, first);
  const bool at_tail = line.portals[bend.arrives].tail_left == bend.left;
  const Half from = at_tail == mirrored_beyond(surface, side) ? side : next(side);
  // Seen from the face before, the crossed side is the right side of the corner that it starts at, otherwise the left side.
  const bool left_now = from != side;
  return turn(surface, from, corner_after(strip, line, bend, bend.leaves), !left_now);
}

Half corner_after(const Strip& strip, const TautLine& line, const Bend& bend, std::size_t portal) {
  const Half h = strip.entered[portal];
  return line.portals[portal].tail_left == bend.left ? h : next(h);
}

TautLine shorten(const PolyhedralSurface& surface, Strip& strip) {
  trim(surface, strip);
  TautLine line = pull_taut(surface, strip);
  for (;;) {
    Strip flipped = strip;
    if (!flip_bends(surface, flipped, line)) return line;
    trim(surface, flipped);
    TautLine shorter = pull_taut(surface, flipped);
    if (!(shorter.length < line.length)) return line;  // no improvement beyond rounding
    strip = std::move(flipped);
    line = std::move(shorter);
  }
}

GeodesicPath path_along(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line) {
  GeodesicPath path;
  path.source = 0;
  path.length = line.length;
  path.start_direction = direction_at(surface, strip.start, line.bends[1].at);
  path.end_direction = direction_at(surface, strip.end, line.arrival);
  path.points.push_back(strip.start.point);
  const std::vector<double> share = line.crossings();
  std::size_t bend = 1;
  for (std::size_t p = 0; p < share.size(); ++p) {
    while (bend + 1 < line.bends.size() && p > line.bends[bend].leaves) ++bend;
    const Bend& at = line.bends[bend];
    if (bend + 1 < line.bends.size() && p >= at.arrives) {
      if (p == at.arrives) path.points.push_back(at_corner(corner_after(strip, line, at, p)));
      // The next bend may be the other end of this portal.
      if (const Bend& then = line.bends[bend + 1]; bend + 2 < line.bends.size() && then.arrives == p)
        path.points.push_back(at_corner(corner_after(strip, line, then, p)));
      continue;
    }
    const double along = line.portals[p].tail_left ? share[p] : 1 - share[p];
    path.points.push_back(point_on(surface, strip.entered[p], along * surface.record(strip.entered[p]).length));
  }
  path.points.push_back(strip.end.point);
  return path;
}

GeodesicPath shortened_path(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) {
  Strip strip = strip_along(surface, curve);
  const TautLine line = shorten(surface, strip);
  return path_along(surface, strip, line);
}

namespace {

using std::numbers::pi;
using Halves = std::vector<Half>;

/// Maximum number of turns of a loop that are concatenated to find where it bends permanently.
constexpr int max_turns = 4096;
/// Maximum number of moves of the base. Every move makes the loop shorter.
constexpr int max_moves = 1000000;

/// A closed walk over faces, and the loop in it through a base point.
class Loop {
 public:
  Loop(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) : surface_(surface) {
    std::vector<MeshPoint> closed(curve.begin(), curve.end());
    closed.push_back(curve.front());
    strip_ = strip_along(surface, closed);
    line_ = shorten(surface_, strip_);
  }

  GeodesicPath tighten() {
    for (int moves = 0; moves < max_moves; ++moves) {
      if (strip_.entered.empty()) return shrunk();
      const std::optional<Halves> closing = closing_half_edges();
      if (!closing) return path_along(surface_, strip_, line_);
      const std::vector<std::pair<Half, bool>> bends = bend_half_edges();
      Halves walk = strip_.entered;
      for (Half h : *closing) enter(surface_, walk, h);
      cancel_ends(walk);
      if (walk.empty()) return shrunk();
      if (!move_base(walk, bends)) return path_along(surface_, strip_, line_);
    }
    throw Error("a loop still became shorter after " + std::to_string(max_moves) + " moves");
  }

 private:
  /// Half-edges from the last face of the strip to its first, around the side of the base on which the loop is shorter; none
  /// where the loop is taut at the base.
  std::optional<Halves> closing_half_edges() const {
    const Half out = strip_.start.corner, in = strip_.end.corner;
    if (out < 0) {
      if (strip_.start.point.face == strip_.last_face()) return Halves{};
      // The base lies on a side; the ends of the strip are in its two faces.
      for (int s = 0; s < 3; ++s) {
        const Half side = 3 * strip_.last_face() + s, there = beyond(surface_, side);
        if (strip_.end.point.barycentric[(s + 2) % 3] == 0 && there >= 0 && there / 3 == strip_.start.point.face)
          return Halves{there};
      }
      throw Error("a loop could not be closed at its base");
    }
    const Index vertex = surface_.record(out).tail;
    const GeodesicPath path = path_along(surface_, strip_, line_);
    const double scale = surface_.angle_scale(vertex), sum = surface_.angle_sum(vertex);
    const double leaving = path.start_direction / scale, arriving = path.end_direction / scale;
    const double between = std::abs(leaving - arriving);
    // The inner angle runs counterclockwise from the departure to the arrival if the angle of the arrival is larger.
    const bool rising = arriving > leaving;
    const bool inside = between < pi - straight_margin;
    const bool outside = !surface_.on_boundary(vertex) && sum - between < pi - straight_margin;
    if (!inside && !outside) return std::nullopt;
    const bool over_inside = inside && (in == out || !outside || between <= sum - between);
    // From the arrival back to the departure.
    const bool clockwise = over_inside == rising;
    return turned(in, out, !clockwise);
  }

  /// Half-edges around the base from one corner to another. `left` is in the orientation of the vertex, not of the face of
  /// `from`.
  Halves turned(Half from, Half to, bool left) const {
    Corner c = surface_.first_corner(surface_.record(from).tail);
    while (c.half != from) c = surface_.turn_left(c);
    const auto way = turn(surface_, from, to, left == c.forward);
    if (!way) throw Error("a loop could not be continued at the boundary");
    return *way;
  }

  /// The half-edges at whose ends the line bends, and whether it bends at their tail.
  std::vector<std::pair<Half, bool>> bend_half_edges() const {
    std::vector<std::pair<Half, bool>> result;
    for (std::size_t k = 1; k + 1 < line_.bends.size(); ++k) {
      const Bend& bend = line_.bends[k];
      const Half h = strip_.entered[bend.arrives];
      result.push_back({h, corner_after(strip_, line_, bend, bend.arrives) == h});
    }
    return result;
  }

  void cancel_ends(Halves& walk) const {
    while (walk.size() > 1 && walk.back() == beyond(surface_, walk.front())) {
      walk.pop_back();
      walk.erase(walk.begin());
    }
  }

  /// Moves the base of the loop to a vertex where the loop bends.
  /// @return false if it bends nowhere: then the loop is a straight closed line
  bool move_base(const Halves& walk, const std::vector<std::pair<Half, bool>>& bends) {
    for (const auto& [half, at_tail] : bends) {
      const auto found = std::find(walk.begin(), walk.end(), half);
      if (found == walk.end()) continue;
      set_base(walk, static_cast<std::size_t>(found - walk.begin()), at_tail);
      return true;
    }
    if (straighten(walk)) return false;
    for (int turns = 4; turns <= max_turns; turns *= 2) {
      const Strip many = along(walk, turns, 0.5);
      const TautLine line = pull_taut(surface_, many);
      // A bend that occurs again one turn later is a bend of the shortest loop in this walk.
      for (std::size_t k = 1; k + 1 < line.bends.size(); ++k) {
        const Bend& bend = line.bends[k];
        const bool again = std::any_of(line.bends.begin() + static_cast<std::ptrdiff_t>(k), line.bends.end() - 1,
                                       [&](const Bend& b) { return b.arrives == bend.arrives + walk.size(); });
        if (!again) continue;
        const std::size_t portal = bend.arrives % walk.size();
        set_base(walk, portal, corner_after(many, line, bend, bend.arrives) == walk[portal]);
        return true;
      }
    }
    throw Error("a loop did not converge: it bends by very little in every turn");
  }

  /// Where one turn of the walk is only a translation, as around a cylinder, the loop may be a straight line. It is placed in
  /// the middle of all lines that stay in the strip.
  bool straighten(const Halves& walk) {
    const std::vector<Portal> portals = pull_taut(surface_, along(walk, 2, 0.5)).portals;
    const Portal &first = portals[0], &again = portals[walk.size()];
    const Vec2 before = first.right - first.left, after = again.right - again.left;
    if (first.tail_left != again.tail_left || !(dot(before, after) > 0) ||
        !(std::abs(cross(before, after)) < straight_margin * dot(before, before)))
      return false;
    const Vec2 shift = again.left - first.left, left = (1 / norm(shift)) * Vec2{-shift[1], shift[0]};
    double low = dot(first.right, left), high = dot(first.left, left);
    for (std::size_t p = 0; p < walk.size(); ++p) {
      low = std::max(low, dot(portals[p].right, left));
      high = std::min(high, dot(portals[p].left, left));
    }
    if (!(low < high)) return false;
    const double from_left = (dot(first.left, left) - (low + high) / 2) / dot(first.left - first.right, left);
    strip_ = along(walk, 1, from_left);
    line_ = pull_taut(surface_, strip_);
    return true;
  }

  /// The strip of several turns of the walk, from a point of the first side crossed to the same point.
  /// @param from_left  fraction of the side, from the left. Seen from the face before, the head of the side is on the left
  Strip along(const Halves& walk, int turns, double from_left) const {
    const Half side = beyond(surface_, walk.front());
    Strip strip;
    strip.start.point = point_on(surface_, side, surface_.record(side).length * (1 - from_left));
    strip.end = strip.start;
    for (int t = 0; t < turns; ++t) strip.entered.insert(strip.entered.end(), walk.begin(), walk.end());
    return strip;
  }

  void set_base(const Halves& walk, std::size_t portal, bool at_tail) {
    const Half corner = at_tail ? walk[portal] : next(walk[portal]);
    strip_.start.corner = corner;
    strip_.start.point = {corner / 3, {0, 0, 0}};
    strip_.start.point.barycentric[corner % 3] = 1;
    strip_.end = strip_.start;
    strip_.entered.assign(walk.begin() + static_cast<std::ptrdiff_t>(portal) + 1, walk.end());
    strip_.entered.insert(strip_.entered.end(), walk.begin(), walk.begin() + static_cast<std::ptrdiff_t>(portal) + 1);
    line_ = shorten(surface_, strip_);
  }

  GeodesicPath shrunk() const {
    GeodesicPath path;
    path.source = 0;
    path.points = {strip_.start.point};
    return path;
  }

  const PolyhedralSurface& surface_;
  Strip strip_;
  TautLine line_;
};

}  // namespace

GeodesicPath shortened_loop(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) {
  if (curve.size() < 2) throw InvalidArgument("a closed curve needs at least 2 points");
  return Loop(surface, curve).tighten();
}

}  // namespace ahm::exact
