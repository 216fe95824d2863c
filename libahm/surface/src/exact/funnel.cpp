#include <algorithm>
#include <cmath>

#include "strip.hpp"

namespace ahm::exact {
namespace {

/// A line that passes a vertex at a smaller angle than this bends there: only then is its other side looked at.
constexpr double touching = 1e-12;

Place turned_left(const Place& v) { return {-v[1], v[0]}; }

/// The side of a face left, in the frame of side 0: seen from inside its head is on the left.
Portal first_portal(const PolyhedralSurface& surface, Half side, bool mirrored) {
  const HalfRecord& r = surface.record(side);
  return {to_first_side(surface, side, {r.length, 0}), to_first_side(surface, side, {0, 0}), !mirrored};
}

/// The frame of a half-edge that enters a face, unfolded.
struct Unfolded {
  Place tail, along, up;

  Unfolded(const Portal& portal) : tail(portal.tail_left ? portal.left : portal.right) {
    const Place across = portal.right - portal.left;
    const Place unit = (1 / norm(across)) * across;
    along = portal.tail_left ? unit : -unit;
    up = turned_left(unit);
  }
  Place out_of(const Place& p) const { return tail + p[0] * along + p[1] * up; }
  Place into(const Place& p) const { return {dot(p - tail, along), dot(p - tail, up)}; }
};

/// The next side crossed: one end stays, the other one is the apex.
Portal next_portal(const PolyhedralSurface& surface, const Portal& portal, Half entered, Half side) {
  const Place top = Unfolded(portal).out_of(apex(surface.record(entered)));
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

/// The funnel: from an apex two chains that bend outwards, to the ends of the portal reached.
class Funnel {
 public:
  explicit Funnel(const Place& start) : left_{0}, right_{0} { nodes_.push_back({start, -1, false, 0, 0}); }

  /// The portal's end on one side is another one than before.
  void add(const Place& at, bool left, std::size_t portal) {
    auto& own = left ? left_ : right_;
    auto& other = left ? right_ : left_;
    auto& own_apex = left ? left_apex_ : right_apex_;
    auto& other_apex = left ? right_apex_ : left_apex_;
    const double sign = left ? 1 : -1;
    // The sine by which the way from a by b to `at` turns outwards; where it is none, whether the way goes on ahead.
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
      if (sine > touching || (sine > -touching && beyond_b)) break;
      own.pop_back();
    }
    if (own.size() - own_apex == 1) {
      // The new end may lie beyond the other chain; not where the start lies between both ends of its portal.
      while (other.size() - other_apex > 1) {
        const std::size_t a = other[other_apex], b = other[other_apex + 1];
        const double sine = turn(a, b);
        if (sine > touching || (sine > -touching && !is_ahead(a, b))) break;
        ++other_apex;
        own.assign(1, b);
        own_apex = 0;
      }
    }
    nodes_.push_back({at, static_cast<std::ptrdiff_t>(own.back()), left, portal, portal});
    own.push_back(nodes_.size() - 1);
  }
  /// The portal keeps an end.
  void keep(bool left, std::size_t portal) { nodes_[latest_[left]].last = portal; }
  void set_latest(bool left) { latest_[left] = nodes_.size() - 1; }

  /// From the start to the node added last.
  std::vector<Bend> bends() const {
    std::vector<std::size_t> chain;
    for (auto k = static_cast<std::ptrdiff_t>(nodes_.size()) - 1; k >= 0; k = nodes_[k].parent)
      chain.push_back(static_cast<std::size_t>(k));
    std::reverse(chain.begin(), chain.end());
    std::vector<Bend> result;
    for (std::size_t k : chain) result.push_back({nodes_[k].at, nodes_[k].left, nodes_[k].first, nodes_[k].last});
    // Two bends that are the ends of one portal: the line runs along it.
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
    std::size_t first, last;  ///< portals that end here
  };
  std::vector<Node> nodes_;
  std::vector<std::size_t> left_, right_;  ///< chains; entries before the apex have been passed
  std::size_t left_apex_ = 0, right_apex_ = 0;
  std::size_t latest_[2] = {0, 0};
};

Place end_of(const PolyhedralSurface& surface, const Strip& strip, const std::vector<Portal>& portals) {
  const Place inside = surface.place(strip.end.point);
  if (portals.empty()) return inside;
  return Unfolded(portals.back()).out_of(from_first_side(surface, strip.entered.back(), inside));
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
    line.arrival = to_first_side(surface, strip.entered.back(), Unfolded(line.portals.back()).into(line.arrival));
  return line;
}

}  // namespace ahm::exact
