#include "propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/error.hpp"
#include "check_point.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A window is dropped where it loses to a known distance by more than this, relatively.
constexpr double slack = 1 + 1e-12;
/// How far beside a window a point still counts as covered, and how wide a window must be; relative to the side.
constexpr double margin = 1e-12, least_width = 1e-14;
/// Rays to a vertex that cross a side closer than this multiple of it may be one ray, past a vertex they both touch.
constexpr double same_ray = 1e-10;
/// Rays that meet a side at a smaller angle, or from its other side by rounding, run along it; its ends see them.
constexpr double least_angle = 1e-15;
/// Added to both ends of the angles that open behind a vertex.
constexpr double wedge_margin = 1e-12;
/// Width of a bucket in mean side lengths, and how many the ring has.
constexpr double bucket_width = 0.25;
constexpr std::uint32_t ring = 4096;

/// Whether an origin lies on the line of a side, in its frame.
bool on_line(const Place& from, double length) { return !(-from[1] > least_angle * (std::abs(from[0]) + length)); }

}  // namespace

Propagation::Propagation(const PolyhedralSurface& surface, double radius, std::span<const MeshPoint> targets,
                         bool only_targets)
    : surface_(surface),
      horizon_(radius),
      only_targets_(only_targets),
      distance_(static_cast<std::size_t>(surface.vertex_count()), infinity),
      target_distance_(targets.size(), infinity),
      reached_(distance_.size() + targets.size()),
      sighting_(3 * static_cast<std::size_t>(surface.face_count()), Sighting{infinity, 0}),
      windows_(bucket_width * surface.mean_length(), ring),
      bends_(bucket_width * surface.mean_length(), ring) {
  place_targets(targets);
}

void Propagation::place_targets(std::span<const MeshPoint> targets) {
  if (targets.empty()) return;
  targets_of_face_.assign(static_cast<std::size_t>(surface_.face_count()) + 1, 0);
  for (const MeshPoint& t : targets) {
    targets_.push_back(surface_.place(t));
    target_vertex_.push_back(vertex_of(surface_, t));
    ++targets_of_face_[t.face + 1];
  }
  for (std::size_t f = 1; f < targets_of_face_.size(); ++f) targets_of_face_[f] += targets_of_face_[f - 1];
  target_order_.resize(targets.size());
  std::vector<Offset> fill(targets_of_face_.begin(), targets_of_face_.end() - 1);
  for (std::size_t k = 0; k < targets.size(); ++k) target_order_[fill[targets[k].face]++] = static_cast<Index>(k);
}

// ---------------------------------------------------------------------------------------------- sources

void Propagation::add_source(const MeshPoint& point) {
  const auto number = static_cast<Index>(origins_.size());
  origins_.push_back({-1, number, 0, 0});
  sources_ = origins_.size();
  const auto origin2 = static_cast<std::uint32_t>(2 * number);
  const Half first = 3 * point.face;
  int zeros = 0, corner = 0, zero = 0;
  for (int s = 0; s < 3; ++s) {
    if (point.barycentric[s] > 0) {
      corner = s;
    } else {
      zero = s;
      ++zeros;
    }
  }
  if (zeros == 2) return add_vertex_source(origin2, surface_.record(first + corner).tail);
  // The sides of the face that the source sees at an angle; the one it lies on, it sees through.
  Ray ray{first, surface_.place(point), 0, origin2};
  for (int s = 0; s < 3; ++s) {
    const HalfRecord& r = surface_.record(ray.half);
    offer(r.apex, distance(ray.from, apex(r)), ray, apex(r));
    if (zeros == 1 && s == zero)
      see_beyond_right(ray);
    else
      light_right(ray, 0, r.right);
    ray = in_next(ray);
  }
  see_face(ray);
}

void Propagation::add_vertex_source(std::uint32_t origin2, Index vertex) {
  if (distance_[vertex] == infinity) ++met_;
  distance_[vertex] = 0;
  Reached& reached = reached_[vertex];
  reached = {-1, static_cast<Index>(origin2 / 2), {}, 0};
  origins_[origin2 / 2].vertex = vertex;
  double turned = 0;
  const Corner first = surface_.first_corner(vertex);
  Corner c = first;
  do {
    const double angle = surface_.angle(c.half);
    const Ray ray = c.forward ? Ray{c.half, {}, turned, origin2} : Ray{c.half, {}, turned + angle, origin2 | 1};
    light_corner(ray, 0, angle);
    turned += angle;
    c = surface_.turn_left(c);
  } while (c.half >= 0 && c != first);
}

/// The same ray in the frame of the next half-edge of its face.
Propagation::Ray Propagation::in_next(const Ray& ray) const {
  const double turn = pi - surface_.angle(next(ray.half));
  return {next(ray.half), exact::in_next(surface_.record(ray.half), ray.from),
          ray.turn + (ray.origin2 & 1 ? -turn : turn), ray.origin2};
}

/// A source on the right side of a half-edge lights the face beyond like its own.
void Propagation::see_beyond_right(const Ray& ray) {
  const HalfRecord& r = surface_.record(ray.half);
  if (r.beyond_right < 0) return;
  Window w = beyond_right(ray, 0, r.right);
  Ray there{w.half, {w.from[0], std::max(0.0, w.from[1])}, w.turn, w.origin2};
  const HalfRecord& face = surface_.record(there.half);
  offer(face.apex, distance(there.from, apex(face)), there, apex(face));
  for (int s = 0; s < 3; ++s) {
    if (s != 2) light_right(there, 0, surface_.record(there.half).right);
    there = in_next(there);
  }
  see_face(there);
}

/// Starts a window across an interval of the frame's right side.
void Propagation::light_right(const Ray& ray, double begin, double end) {
  const HalfRecord& r = surface_.record(ray.half);
  if (r.beyond_right < 0 || !(end - begin > least_width * r.right)) return;
  Window w = beyond_right(ray, begin, end);
  if (on_line(w.from, r.right)) return;
  const double sigma = origins_[w.origin()].distance;
  const bool mirror = (r.mirrored & 2) != 0;
  const Index tail = mirror ? r.head : r.apex, head = mirror ? r.apex : r.head;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  if (at_end > (distance_[tail] + w.end) * slack || at_begin > (distance_[head] + r.right - w.begin) * slack) return;
  push(w, sigma, at_begin, at_end);
}

/// The window through an interval of the right side, from its apex, as the face beyond sees it.
Window Propagation::beyond_right(const Ray& ray, double begin, double end) const {
  const HalfRecord& r = surface_.record(ray.half);
  const double turn = surface_.angle(next(ray.half));
  Window w{begin,          end,        exact::beyond_right(r, ray.from), ray.turn - (ray.origin2 & 1 ? -turn : turn),
           r.beyond_right, ray.origin2};
  if (r.mirrored & 2) mirror(w, r.right);
  return w;
}

void Propagation::mirror(Window& w, double length) {
  w = {length - w.end, length - w.begin, {length - w.from[0], w.from[1]}, w.turn + (w.mirrored() ? -pi : pi),
       w.half,         w.origin2 ^ 1};
}

/// Lights the face of a corner from its vertex, between two angles from its half-edge.
void Propagation::light_corner(const Ray& ray, double low, double high) {
  const HalfRecord& r = surface_.record(ray.half);
  const double angle = surface_.angle(ray.half), sigma = origins_[ray.origin2 / 2].distance;
  const double back = ray.origin2 & 1 ? pi - angle : angle - pi;
  offer(r.apex, sigma + r.left, ray, apex(r));
  offer(r.head, sigma + r.length, {previous(ray.half), {r.left, 0}, ray.turn + back, ray.origin2},
        apex(surface_.record(previous(ray.half))));
  const Place from = exact::beyond_right(r, {});
  auto crossing = [&](double phi) { return from[0] - from[1] / std::tan(phi + surface_.angle(next(ray.half))); };
  light_right(ray, high >= angle ? 0.0 : std::max(0.0, crossing(high)),
              low <= 0 ? r.right : std::min(r.right, crossing(low)));
  see_face(ray);
}

// ---------------------------------------------------------------------------------------------- bends

/// Shortest paths go on behind a vertex where both sides have at least pi.
void Propagation::bend(const Bend& event) {
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
void Propagation::fill(Corner c, double turned, double high, std::uint32_t origin2) {
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
void Propagation::push(const Window& w, double sigma, double at_begin, double at_end) {
  const bool across = w.from[0] >= w.begin && w.from[0] <= w.end;
  const double key = across ? sigma - w.from[1] : std::min(at_begin, at_end);
  if (key > horizon_) return;
  windows_.push(key, w);
  ++made_;
}

void Propagation::cross_face(const Window& w) {
  const HalfRecord& r = surface_.record(w.half);
  const double sigma = origins_[w.origin()].distance;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  // [XW09], again: distances may have become shorter while it waited.
  if (at_end > (distance_[r.tail] + w.end) * slack || at_begin > (distance_[r.head] + r.length - w.begin) * slack)
    return;
  if (!targets_of_face_.empty()) see_targets(w, sigma);

  const double up = r.apex_y - w.from[1];
  const double crossing = w.from[0] - (r.apex_x - w.from[0]) * w.from[1] / up;
  const double beside = margin * r.length;
  bool left = crossing > w.begin, right = crossing < w.end;
  double to_apex = 0;
  if (crossing > w.begin - beside && crossing < w.end + beside) {
    to_apex = sigma + distance(w.from, apex(r));
    offer(r.apex, to_apex, {w.half, w.from, w.turn, w.origin2}, apex(r));
    // One angle, one split [CH90].
    Sighting& best = sighting_[w.half];
    if (to_apex < best.distance) {
      best = {to_apex, crossing};
    } else if (to_apex > best.distance * slack && std::abs(crossing - best.crossing) > same_ray * r.length) {
      (crossing < best.crossing ? right : left) = false;
    }
  }
  if (left && r.beyond_left >= 0) go_left(w, r, sigma, crossing < w.end ? to_apex : 0);
  if (right && r.beyond_right >= 0) go_right(w, r, sigma, crossing > w.begin ? to_apex : 0);
}

/// The part of a window that goes on through the side tail - apex.
/// @param to_apex  sigma and the distance of the apex where the window ends there, else 0
void Propagation::go_left(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double down = -w.from[1];
  auto hit = [&](double t) { return t * down / (down * r.apex_x + (w.from[0] - t) * r.apex_y) * r.left; };
  const double begin = std::max(0.0, hit(w.begin)), end = to_apex > 0 ? r.left : std::min(r.left, hit(w.end));
  if (!(end - begin > least_width * r.left)) return;
  const Place from = beyond_left(r, w.from);
  if (on_line(from, r.left)) return;
  const double at_begin = sigma + distance(from, {begin, 0});
  const double at_end = to_apex > 0 ? to_apex : sigma + distance(from, {end, 0});
  if (at_end > (distance_[r.tail] + end) * slack || at_begin > (distance_[r.apex] + r.left - begin) * slack) return;
  const double part = begin / r.left;
  if (at_begin > (distance_[r.head] + distance({r.length, 0}, {part * r.apex_x, part * r.apex_y})) * slack) return;
  const double turn = surface_.angle(w.half);
  Window child{begin, end, from, w.turn + (w.mirrored() ? -turn : turn), r.beyond_left, w.origin2};
  if (r.mirrored & 1) mirror(child, r.left);
  push(child, sigma, at_begin, at_end);
}

/// The part that goes on through the side apex - head.
void Propagation::go_right(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double down = -w.from[1], base = r.length - r.apex_x, x = r.length - w.from[0];
  auto hit = [&](double t) {
    const double u = r.length - t;
    return r.right - u * down / (down * base + (x - u) * r.apex_y) * r.right;
  };
  const double begin = to_apex > 0 ? 0 : std::max(0.0, hit(w.begin)), end = std::min(r.right, hit(w.end));
  if (!(end - begin > least_width * r.right)) return;
  const Place from = exact::beyond_right(r, w.from);
  if (on_line(from, r.right)) return;
  const double at_begin = to_apex > 0 ? to_apex : sigma + distance(from, {begin, 0});
  const double at_end = sigma + distance(from, {end, 0});
  if (at_end > (distance_[r.apex] + end) * slack || at_begin > (distance_[r.head] + r.right - begin) * slack) return;
  const double part = (r.right - end) / r.right;
  if (at_end > (distance_[r.tail] + distance({0, 0}, {r.length - part * base, part * r.apex_y})) * slack) return;
  const double turn = surface_.angle(next(w.half));
  Window child{begin, end, from, w.turn - (w.mirrored() ? -turn : turn), r.beyond_right, w.origin2};
  if (r.mirrored & 2) mirror(child, r.right);
  push(child, sigma, at_begin, at_end);
}

// ---------------------------------------------------------------------------------------------- what is reached

Reached Propagation::reach(const Ray& ray, const Place& at) const {
  const auto origin = static_cast<Index>(ray.origin2 / 2);
  if (ray.origin2 / 2 >= sources_) return {ray.half, origin, ray.from, origins_[origin].direction};
  const double angle = std::atan2(at[1] - ray.from[1], at[0] - ray.from[0]);
  return {ray.half, origin, ray.from, ray.turn + (ray.origin2 & 1 ? -angle : angle)};
}

void Propagation::offer(Index vertex, double distance, const Ray& ray, const Place& at) {
  if (!(distance < distance_[vertex])) return;
  if (distance_[vertex] == infinity) ++met_;
  distance_[vertex] = distance;
  reached_[vertex] = reach(ray, at);
  if (distance <= horizon_ && surface_.bends_paths(vertex)) bends_.push(distance, {vertex, distance});
}

/// Offers straight ways to all targets in the face that a ray starts in.
void Propagation::see_face(const Ray& ray) {
  if (targets_of_face_.empty()) return;
  see_targets({-infinity, infinity, ray.from, ray.turn, ray.half, ray.origin2}, origins_[ray.origin2 / 2].distance);
}

void Propagation::see_targets(const Window& w, double sigma) {
  const Index face = w.half / 3;
  const HalfRecord& side0 = surface_.record(3 * face);
  const HalfRecord& r = surface_.record(w.half);
  for (Offset k = targets_of_face_[face]; k < targets_of_face_[face + 1]; ++k) {
    const Index target = target_order_[k];
    const Place& placed = targets_[target];
    const int s = w.half % 3;
    const Place at = s == 0 ? placed : s == 1 ? exact::in_next(side0, placed) : in_previous(side0, placed);
    if (std::isfinite(w.begin)) {
      const double crossing = w.from[0] - (at[0] - w.from[0]) * w.from[1] / (at[1] - w.from[1]);
      if (!(crossing > w.begin - margin * r.length && crossing < w.end + margin * r.length)) continue;
    }
    const double d = sigma + distance(w.from, at);
    if (!(d < target_distance_[target])) continue;
    target_distance_[target] = d;
    Reached& reached = reached_[distance_.size() + target];
    reached = reach({w.half, w.from, w.turn, w.origin2}, at);
    reached.from = s == 0 ? w.from : s == 1 ? in_previous(r, w.from) : exact::in_next(r, w.from);
    reached.half = 3 * face;
  }
}

namespace {

/// Many times what has been seen of any mesh, and no less than the bound of [MMP87]. Windows beyond run in circles, where
/// lengths are below the rounding of distances.
double most_windows(double faces) { return 1e6 + faces * faces; }

}  // namespace

void Propagation::run(const Progress& progress) {
  const double all = static_cast<double>(distance_.size()), most = most_windows(surface_.face_count());
  Offset chunks = 0;
  while (!windows_.empty() || !bends_.empty()) {
    progress.step("windows", met_ / all);
    if (windows_.key() > horizon_ || (only_targets_ && targets_final())) break;
    while (!windows_.bucket_empty() || !bends_.bucket_empty()) {
      while (!bends_.bucket_empty()) bends_.drain_chunk([this](const Bend& b) { bend(b); });
      if (windows_.bucket_empty()) continue;
      windows_.drain_chunk([this](const Window& w) { cross_face(w); });
      if (static_cast<double>(made_) > most)
        throw InvalidGeometry("windows_without_end", "windows without end: lengths of sides differ too much",
                              "repair the mesh, or use heat");
      if (++chunks % 65536 == 0) progress.step("windows", met_ / all);
    }
    windows_.advance();
    bends_.advance();
  }
  progress.step("windows", 1);
  copy_vertex_targets();
}

/// A target at a vertex is that vertex.
void Propagation::copy_vertex_targets() {
  for (std::size_t k = 0; k < target_vertex_.size(); ++k) {
    if (target_vertex_[k] < 0) continue;
    target_distance_[k] = distance_[target_vertex_[k]];
    reached_[distance_.size() + k] = reached_[target_vertex_[k]];
  }
}

/// Whether nothing that waits can reach a target any earlier.
bool Propagation::targets_final() {
  copy_vertex_targets();
  double farthest = 0;
  for (double d : target_distance_) farthest = std::max(farthest, d);
  horizon_ = std::min(horizon_, farthest);
  return windows_.key() > horizon_;
}

std::size_t Propagation::bytes() const {
  return windows_.bytes() + bends_.bytes() + distance_.capacity() * sizeof(double) +
         reached_.capacity() * sizeof(Reached) + sighting_.capacity() * sizeof(Sighting) +
         origins_.capacity() * sizeof(Origin) + targets_.capacity() * sizeof(Vec2);
}

}  // namespace ahm::exact
