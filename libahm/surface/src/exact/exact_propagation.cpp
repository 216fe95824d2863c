#include "exact_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ahm::exact {
namespace {

using std::numbers::pi;

/// Rays to a vertex that cross a side closer than this multiple of it may be one ray, past a vertex they both touch.
constexpr double same_ray = 1e-10;
/// Angle by which rays past a vertex miss it where the surface is flat up to rounding: what many such vertices on one line add up
/// to is more than a share of a side, far away.
constexpr double missed_angle = 1e-12;
/// Added to both ends of the angles that open behind a vertex.
constexpr double wedge_margin = 1e-12;

}  // namespace

ExactPropagation::ExactPropagation(const PolyhedralSurface& surface, const ExactOptions& options,
                                   std::span<const MeshPoint> targets)
    : Propagation(surface, options, targets),
      sighting_(3 * static_cast<std::size_t>(surface.face_count()), Sighting{infinity, 0}),
      windows_(bucket_width * surface.mean_length()),
      bends_(bucket_width * surface.mean_length()) {}

void ExactPropagation::start(const Window& w) {
  const double sigma = origins_[w.origin()].distance;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  if (!loses(w, at_begin, at_end)) push(w, sigma, at_begin, at_end);
}

void ExactPropagation::nearer(std::size_t row, double distance, double /*error*/) {
  if (row >= distance_.size()) return;
  const auto vertex = static_cast<Index>(row);
  if (distance <= horizon_ && surface_.bends_paths(vertex)) bends_.push(distance, {vertex, distance});
}

// ---------------------------------------------------------------------------------------------- bends

/// Shortest paths go on behind a vertex where both sides have at least pi.
void ExactPropagation::bend(const Bend& event) {
  const Index v = event.vertex;
  if (event.distance > distance_[v]) return;
  const Reached& in = reached_[v];
  const Origin from = origins_[in.origin];
  const auto origin2 = static_cast<std::uint32_t>(2 * origins_.size());
  origins_.push_back({v, from.source, event.distance, in.direction});
  const Half corner = previous(in.half);
  const Place back = in_previous(surface_.record(in.half), in.from);
  const double angle = surface_.angle(corner), inwards = std::clamp(std::atan2(back[1], back[0]), 0.0, angle);
  if (surface_.on_boundary(v)) {
    fill({corner, true}, -inwards, infinity, origin2);
    fill({corner, false}, inwards - angle, infinity, origin2);
  } else {
    fill({corner, true}, -inwards, surface_.angle_sum(v) - pi + wedge_margin, origin2);
  }
}

/// Turns left from a corner, whose right side is at the angle `turned` from the way in, and lights what lies between pi
/// and `high`.
void ExactPropagation::fill(Corner c, double turned, double high, std::uint32_t origin2) {
  constexpr double low = pi - wedge_margin;
  for (; c.half >= 0 && turned < high; c = surface_.turn_left(c)) {
    const double angle = surface_.angle(c.half);
    if (turned + angle > low) {
      const Ray ray{c.half, {}, 0, origin2};
      c.forward ? light_corner(ray, low - turned, high - turned)
                : light_corner(ray, angle + turned - high, angle + turned - low);
    }
    turned += angle;
  }
}

// ---------------------------------------------------------------------------------------------- windows

/// Keeps a window for later.
void ExactPropagation::push(const Window& w, double sigma, double at_begin, double at_end) {
  const bool across = w.from[0] >= w.begin && w.from[0] <= w.end;
  const double key = across ? sigma - w.from[1] : std::min(at_begin, at_end);
  if (key > horizon_) return;
  windows_.push(key, w);
  ++made_;
}

/// Whether no shortest path crosses a window, since one of the ends of its half-edge is nearer [XW09].
bool ExactPropagation::loses(const Window& w, double at_begin, double at_end) const {
  const HalfRecord& r = surface_.record(w.half);
  return at_end > (distance_[r.tail] + w.end) * slack || at_begin > (distance_[r.head] + r.length - w.begin) * slack;
}

void ExactPropagation::cross_face(const Window& w) {
  const HalfRecord& r = surface_.record(w.half);
  const double sigma = origins_[w.origin()].distance;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  if (loses(w, at_begin, at_end)) return;  // again: distances may have become shorter while it waited
  if (has_targets()) see_targets_of(w, sigma);

  const double crossing = crossing_to(w.from, apex(r));
  const double across = crossing - w.from[0], down = -w.from[1];
  const double beside = window_margin * r.length + missed_angle * (across * across + down * down) / down;
  bool left = crossing > w.begin, right = crossing < w.end;
  double to_apex = 0;
  if (crossing > w.begin - beside && crossing < w.end + beside) {
    to_apex = sigma + distance(w.from, apex(r));
    offer(r.apex, to_apex, {w.half, w.from, w.turn, w.origin2}, apex(r));
    // One angle, one split [CH90].
    Sighting& best = sighting_[w.half];
    if (to_apex < best.distance) {
      best = {to_apex, crossing};
      if (!sighting_from_.empty()) sighting_from_[w.half] = w.from;
    } else if (to_apex > best.distance * slack && std::abs(crossing - best.crossing) > same_ray * r.length) {
      const bool rightwards = crossing < best.crossing;
      if (hides(w, rightwards)) (rightwards ? right : left) = false;
    }
  }
  if (left && r.beyond_left >= 0) go_left(w, r, sigma, crossing < w.end ? to_apex : 0);
  if (right && r.beyond_right >= 0) go_right(w, r, sigma, crossing > w.begin ? to_apex : 0);
}

/// Whether all rays of a window to the right (left) of the apex cross the way from the origin of the best one to the apex.
/// Some may pass that origin where it is a source inside the window, one of several.
bool ExactPropagation::hides(const Window& w, bool right) const {
  if (sighting_from_.empty()) return true;
  const Sighting& best = sighting_[w.half];
  const double last = right ? w.end : w.begin;
  const double beyond = cross(Place{last, 0} - w.from, sighting_from_[w.half] - w.from);
  return right ? last <= best.crossing || beyond < 0 : last >= best.crossing || beyond > 0;
}

/// The part of a window that goes on through the side tail - apex.
/// @param to_apex  sigma and the distance of the apex where the window ends there, else 0
void ExactPropagation::go_left(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double begin = std::max(0.0, hit_left(r, w.from, w.begin));
  const double end = to_apex > 0 ? r.left : std::min(r.left, hit_left(r, w.from, w.end));
  if (!(end - begin > least_width * r.left)) return;
  const Place from = beyond_left(r, w.from);
  if (on_line(from, r.left)) return;
  const double at_begin = sigma + distance(from, {begin, 0});
  const double at_end = to_apex > 0 ? to_apex : sigma + distance(from, {end, 0});
  if (at_end > (distance_[r.tail] + end) * slack || at_begin > (distance_[r.apex] + r.left - begin) * slack) return;
  if (at_begin > (distance_[r.head] + distance({r.length, 0}, on_left(r, begin))) * slack) return;
  const double turn = surface_.angle(w.half);
  Window child{begin, end, from, w.turn + (w.mirrored() ? -turn : turn), r.beyond_left, w.origin2};
  if (r.mirrored & 1) mirror(child, r.left);
  push(child, sigma, at_begin, at_end);
}

/// The part that goes on through the side apex - head.
void ExactPropagation::go_right(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double begin = to_apex > 0 ? 0 : std::max(0.0, hit_right(r, w.from, w.begin));
  const double end = std::min(r.right, hit_right(r, w.from, w.end));
  if (!(end - begin > least_width * r.right)) return;
  const Place from = exact::beyond_right(r, w.from);
  if (on_line(from, r.right)) return;
  const double at_begin = to_apex > 0 ? to_apex : sigma + distance(from, {begin, 0});
  const double at_end = sigma + distance(from, {end, 0});
  if (at_end > (distance_[r.apex] + end) * slack || at_begin > (distance_[r.head] + r.right - begin) * slack) return;
  if (at_end > (distance_[r.tail] + distance({0, 0}, on_right(r, end))) * slack) return;
  const double turn = surface_.angle(next(w.half));
  Window child{begin, end, from, w.turn - (w.mirrored() ? -turn : turn), r.beyond_right, w.origin2};
  if (r.mirrored & 2) mirror(child, r.right);
  push(child, sigma, at_begin, at_end);
}

void ExactPropagation::see_targets_of(const Window& w, double sigma) {
  const double margin = window_margin * surface_.record(w.half).length;
  see_targets(
      w.half, w.from, sigma,
      [&](const Place& at) {
        const double crossing = crossing_to(w.from, at);
        return crossing > w.begin - margin && crossing < w.end + margin;
      },
      [&](const Place& at) {
        return reach({w.half, w.from, w.turn, w.origin2}, at);
      },
      [](const Place&) { return 0.0; });
}

void ExactPropagation::run(const Progress& progress) {
  const auto inside = [](const Origin& source) { return source.vertex < 0; };
  if (sources_ > 1 && std::any_of(origins_.begin(), origins_.end(), inside)) sighting_from_.resize(sighting_.size());
  drain(
      bends_, [this](const Bend& b) { bend(b); }, windows_, [this](const Window& w) { cross_face(w); }, progress);
  progress.step("windows", 1);
  copy_vertex_targets();
}

double ExactPropagation::farthest_target() {
  copy_vertex_targets();
  double farthest = 0;
  for (double d : target_distance_) farthest = std::max(farthest, d);
  return farthest;
}

std::size_t ExactPropagation::bytes() const {
  return Propagation::bytes() + windows_.bytes() + bends_.bytes() + sighting_.capacity() * sizeof(Sighting) +
         sighting_from_.capacity() * sizeof(Place);
}

}  // namespace ahm::exact
