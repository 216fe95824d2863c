#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/exact/shortened_path.hpp"
#include "shorten.hpp"
#include "walk.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;
using Halves = std::vector<Half>;

/// Turns of a loop that are laid one behind the other to find where it bends for good.
constexpr int most_turns = 4096;
/// Moves of the base; every one makes the loop shorter.
constexpr int most_moves = 1000000;

/// A closed walk over faces, and the loop in it through a base.
class Loop {
 public:
  Loop(const PolyhedralSurface& surface, std::span<const MeshPoint> curve) : surface_(surface) {
    std::vector<MeshPoint> closed(curve.begin(), curve.end());
    closed.push_back(curve.front());
    strip_ = strip_along(surface, closed);
    line_ = shorten(surface_, strip_);
  }

  GeodesicPath tighten() {
    for (int moves = 0; moves < most_moves; ++moves) {
      if (strip_.entered.empty()) return shrunk();
      const std::optional<Halves> closing = closed_at_base();
      if (!closing) return path_along(surface_, strip_, line_);
      const std::vector<std::pair<Half, bool>> bends = bent_at();
      Halves walk = strip_.entered;
      for (Half h : *closing) enter(surface_, walk, h);
      cancel_ends(walk);
      if (walk.empty()) return shrunk();
      if (!take_base(walk, bends)) return path_along(surface_, strip_, line_);
    }
    throw Error("a loop was still getting shorter after " + std::to_string(most_moves) + " moves");
  }

 private:
  /// What leads from the last face of the strip to its first, by the side of the base on which the loop is shorter; none
  /// where it is taut there.
  std::optional<Halves> closed_at_base() const {
    const Half out = strip_.start.corner, in = strip_.end.corner;
    if (out < 0) {
      if (strip_.start.point.face == strip_.last_face()) return Halves{};
      // The base lies on a side, with the ends of the strip in both its faces.
      for (int s = 0; s < 3; ++s) {
        const Half side = 3 * strip_.last_face() + s, there = beyond(surface_, side);
        if (strip_.end.point.barycentric[(s + 2) % 3] == 0 && there >= 0 && there / 3 == strip_.start.point.face)
          return Halves{there};
      }
      throw Error("a loop was lost at its base");
    }
    const Index vertex = surface_.record(out).tail;
    const GeodesicPath path = path_along(surface_, strip_, line_);
    const double scale = surface_.angle_scale(vertex), sum = surface_.angle_sum(vertex);
    const double leaving = path.start_direction / scale, arriving = path.end_direction / scale;
    const double between = std::abs(leaving - arriving);
    // Counter-clockwise from where it leaves to where it arrives is the inner angle where that is the larger number.
    const bool rising = arriving > leaving;
    const bool inside = between < pi - straight_margin;
    const bool outside = !surface_.on_boundary(vertex) && sum - between < pi - straight_margin;
    if (!inside && !outside) return std::nullopt;
    const bool over_inside = inside && (in == out || !outside || between <= sum - between);
    // From the arrival back to the way out.
    const bool clockwise = over_inside == rising;
    return turned(in, out, !clockwise);
  }

  /// About the base from a corner to another. The direction is that of the vertex, not of the face of `from`.
  Halves turned(Half from, Half to, bool left) const {
    Corner c = surface_.first_corner(surface_.record(from).tail);
    while (c.half != from) c = surface_.turn_left(c);
    const auto way = turn(surface_, from, to, left == c.forward);
    if (!way) throw Error("a loop was lost at the boundary");
    return *way;
  }

  /// The half-edges at whose ends the line bends: which, and whether at the tail.
  std::vector<std::pair<Half, bool>> bent_at() const {
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

  /// The loop through another vertex where it bends.
  /// @return false where it does nowhere: a straight closed line, which is then the loop
  bool take_base(const Halves& walk, const std::vector<std::pair<Half, bool>>& bends) {
    for (const auto& [half, at_tail] : bends) {
      const auto found = std::find(walk.begin(), walk.end(), half);
      if (found == walk.end()) continue;
      base_at(walk, static_cast<std::size_t>(found - walk.begin()), at_tail);
      return true;
    }
    if (take_straight(walk)) return false;
    for (int turns = 4; turns <= most_turns; turns *= 2) {
      const Strip many = along(walk, turns, 0.5);
      const TautLine line = pull_taut(surface_, many);
      // A bend that comes again a turn later is one of the shortest loop in this walk.
      for (std::size_t k = 1; k + 1 < line.bends.size(); ++k) {
        const Bend& bend = line.bends[k];
        const bool again = std::any_of(line.bends.begin() + static_cast<std::ptrdiff_t>(k), line.bends.end() - 1,
                                       [&](const Bend& b) { return b.arrives == bend.arrives + walk.size(); });
        if (!again) continue;
        const std::size_t portal = bend.arrives % walk.size();
        base_at(walk, portal, corner_after(many, line, bend, bend.arrives) == walk[portal]);
        return true;
      }
    }
    throw Error("a loop that turns by very little at every turn was not followed to its end");
  }

  /// Where a turn of the walk is nothing but a shift, as around a cylinder, the loop may be a straight line: in the middle
  /// of all those that stay in the strip.
  bool take_straight(const Halves& walk) {
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

  /// From a point of the first side crossed to itself.
  /// @param from_left  its share of the side, seen from the face before: there its head is on the left
  Strip along(const Halves& walk, int turns, double from_left) const {
    const Half side = beyond(surface_, walk.front());
    Strip strip;
    strip.start.point = point_on(surface_, side, surface_.record(side).length * (1 - from_left));
    strip.end = strip.start;
    for (int t = 0; t < turns; ++t) strip.entered.insert(strip.entered.end(), walk.begin(), walk.end());
    return strip;
  }

  void base_at(const Halves& walk, std::size_t portal, bool at_tail) {
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
