#include "exact/propagation.hpp"

#include <numbers>
#include <utility>

#include "exact/shortened_path.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

/// Maximum number of windows: far more than any known mesh requires, and at least the bound of [MMP87]. More windows run in
/// circles, where lengths are below the rounding error of distances.
double max_windows(double faces) { return 1e6 + faces * faces; }
/// Margin around a window in which points are still covered, and minimum width of a window; relative to the side.
constexpr double window_margin = 1e-12, min_width = 1e-14;
/// A window is dropped where its distance exceeds a known distance by more than this factor.
constexpr double slack = 1 + 1e-12;
/// Width of a bucket in mean side lengths.
constexpr double bucket_width = 0.25;
/// Rays to a vertex that cross a side closer than this multiple of it may be one ray, past a vertex that both touch.
constexpr double same_ray = 1e-10;
/// Angle by which rays past a vertex may miss it where the surface is flat up to rounding. The errors of many such vertices on
/// one line add up, far away, to more than `window_margin` of a side.
constexpr double missed_angle = 1e-12;
/// Margin at both ends of the range of angles behind a vertex.
constexpr double wedge_margin = 1e-12;

/// Whether an origin lies on the line of a side, in the side's frame. Rays that meet the side at a smaller angle, or from its
/// other side by rounding, run along it. They are handled at the ends of the side.
bool on_line(const Place& from, double length) { return !(-from[1] > 1e-15 * (std::abs(from[0]) + length)); }

}  // namespace

Propagation::Propagation(const PolyhedralSurface& surface, const ExactOptions& options,
                         std::span<const MeshPoint> targets)
    : surface_(surface),
      horizon_(options.radius),
      only_targets_(options.only_targets),
      max_windows_(options.max_windows),
      max_vertices_(options.max_vertices),
      distance_(static_cast<std::size_t>(surface.vertex_count()), infinity),
      target_distance_(targets.size(), infinity),
      reached_(distance_.size() + targets.size()),
      apex_arrivals_(3 * static_cast<std::size_t>(surface.face_count()), ApexArrival{infinity, 0}) {
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

void Propagation::add_sources(std::span<const MeshPoint> points) {
  // Components without a source do not determine the buckets. In buckets that are too wide the order of windows is lost. The sides
  // around the source may be much shorter than the mean; a small horizon is a few of them.
  constexpr double sides_to_horizon = 2;
  double edge = horizon_ / sides_to_horizon;
  for (const MeshPoint& point : points)
    edge = std::min(edge, surface_.component_details(surface_.component(point)).mean_length);
  windows_.clear(bucket_width * edge);
  bends_.clear(bucket_width * edge);
  for (const MeshPoint& point : points) add_source(point);
}

void Propagation::add_source(const MeshPoint& point) {
  const auto number = static_cast<Index>(origins_.size());
  origins_.push_back({.source = number});
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
  // Light the sides of the face. Where the source lies on a side, up to rounding, light the face beyond it instead.
  Ray ray{first, surface_.place(point), 0, origin2};
  for (int s = 0; s < 3; ++s) {
    const HalfRecord& r = surface_.record(ray.half);
    offer(r.apex, distance(ray.from, apex(r)), ray, apex(r));
    if ((zeros == 1 && s == zero) || on_line(exact::beyond_right(r, ray.from), r.right))
      light_face_beyond_right(ray);
    else
      light_right(ray, 0, r.right);
    ray = in_next(ray);
  }
  offer_targets_in_face(ray);
}

void Propagation::add_vertex_source(std::uint32_t origin2, Index vertex) {
  if (distance_[vertex] == infinity) touched_.push_back(vertex);
  distance_[vertex] = 0;
  ArrivalRecord& reached = reached_[vertex];
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

/// The ray in the frame of the next half-edge of its face.
Propagation::Ray Propagation::in_next(const Ray& ray) const {
  const double turn = pi - surface_.angle(next(ray.half));
  return {next(ray.half), exact::in_next(surface_.record(ray.half), ray.from),
          ray.turn + (ray.origin2 & 1 ? -turn : turn), ray.origin2};
}

/// Handles a source on the right side of a half-edge: it lights the face beyond that side like its own face.
void Propagation::light_face_beyond_right(const Ray& ray) {
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
  offer_targets_in_face(there);
}

/// Starts a window through an interval of the right side of the ray's half-edge.
void Propagation::light_right(const Ray& ray, double begin, double end) {
  const HalfRecord& r = surface_.record(ray.half);
  if (r.beyond_right < 0 || !(end - begin > min_width * r.right)) return;
  Window w = beyond_right(ray, begin, end);
  if (on_line(w.from, r.right)) return;
  const double sigma = origins_[w.origin()].distance;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  if (!loses(w, surface_.record(w.half), at_begin, at_end)) push(w, sigma, at_begin, at_end);
}

/// The window through an interval of the right side, measured from its apex, in the frame of the face beyond.
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

/// Lights the face of a corner from its vertex, between two angles measured from the corner's half-edge.
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
  offer_targets_in_face(ray);
}

// ---------------------------------------------------------------------------------------------- results

ArrivalRecord Propagation::reach(const Ray& ray, const Place& at) const {
  const auto origin = static_cast<Index>(ray.origin2 / 2);
  const bool mirrored = origins_[origin].mirrored != ((ray.origin2 & 1) != 0);
  if (ray.origin2 / 2 >= sources_) return {ray.half, origin, ray.from, origins_[origin].direction, mirrored};
  const double angle = std::atan2(at[1] - ray.from[1], at[0] - ray.from[0]);
  return {ray.half, origin, ray.from, ray.turn + (ray.origin2 & 1 ? -angle : angle), mirrored};
}

/// Sets the distance of a vertex if it is shorter.
void Propagation::offer(Index vertex, double distance, const Ray& ray, const Place& at) {
  if (!(distance < distance_[vertex])) return;
  if (distance_[vertex] == infinity) touched_.push_back(vertex);
  distance_[vertex] = distance;
  reached_[vertex] = reach(ray, at);
  if (distance <= horizon_ && surface_.bends_paths(vertex)) bends_.push(distance, {vertex, distance});
}

template <class Covers>
void Propagation::offer_targets(const Ray& ray, const Covers& covers) {
  const double sigma = origins_[ray.origin2 / 2].distance;
  const Index face = ray.half / 3;
  const HalfRecord& side0 = surface_.record(3 * face);
  const HalfRecord& r = surface_.record(ray.half);
  const int s = ray.half % 3;
  for (Offset k = targets_of_face_[face]; k < targets_of_face_[face + 1]; ++k) {
    const Index target = target_order_[k];
    const Place& placed = targets_[target];
    const Place at = s == 0 ? placed : s == 1 ? exact::in_next(side0, placed) : in_previous(side0, placed);
    const double d = sigma + distance(ray.from, at);
    if (!(d < target_distance_[target]) || !covers(at)) continue;
    target_distance_[target] = d;
    ArrivalRecord& there = reached_[distance_.size() + target];
    there = reach(ray, at);
    there.from = s == 0 ? ray.from : s == 1 ? in_previous(r, ray.from) : exact::in_next(r, ray.from);
    there.half = 3 * face;
  }
}

/// Offers straight paths to all targets in the face where a ray starts.
void Propagation::offer_targets_in_face(const Ray& ray) {
  if (has_targets()) offer_targets(ray, [](const Place&) { return true; });
}

void Propagation::offer_targets_of(const Window& w) {
  const double margin = window_margin * surface_.record(w.half).length;
  offer_targets({w.half, w.from, w.turn, w.origin2}, [&](const Place& at) {
    const double crossing = crossing_to(w.from, at);
    return crossing > w.begin - margin && crossing < w.end + margin;
  });
}

void Propagation::copy_vertex_targets() {
  for (std::size_t k = 0; k < target_vertex_.size(); ++k) {
    if (target_vertex_[k] < 0) continue;
    target_distance_[k] = distance_[target_vertex_[k]];
    reached_[distance_.size() + k] = reached_[target_vertex_[k]];
  }
}

double Propagation::farthest_target() {
  copy_vertex_targets();
  double farthest = 0;
  for (double d : target_distance_) farthest = std::max(farthest, d);
  return farthest;
}

// ---------------------------------------------------------------------------------------------- bends

/// Continues shortest paths behind a vertex, where both sides have an angle of at least pi.
void Propagation::bend(const Bend& event) {
  const Index v = event.vertex;
  if (event.distance > distance_[v]) return;
  const ArrivalRecord& in = reached_[v];
  const Origin from = origins_[in.origin];
  const auto origin2 = static_cast<std::uint32_t>(2 * origins_.size());
  origins_.push_back({v, from.source, event.distance, in.direction, in.mirrored});
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

/// Turns left from a corner and lights the angles between pi and `high`. `turned` is the angle from the incoming path to the
/// right side of the corner.
void Propagation::fill(Corner c, double turned, double high, std::uint32_t origin2) {
  constexpr double low = pi - wedge_margin;
  const bool forward = c.forward;
  for (; c.half >= 0 && turned < high; c = surface_.turn_left(c)) {
    const double angle = surface_.angle(c.half);
    if (turned + angle > low) {
      const Ray ray{c.half, {}, 0, origin2 + (c.forward != forward)};
      c.forward ? light_corner(ray, low - turned, high - turned)
                : light_corner(ray, angle + turned - high, angle + turned - low);
    }
    turned += angle;
  }
}

// ---------------------------------------------------------------------------------------------- windows

/// Queues a window.
void Propagation::push(const Window& w, double sigma, double at_begin, double at_end) {
  const bool across = w.from[0] >= w.begin && w.from[0] <= w.end;
  const double key = across ? sigma - w.from[1] : std::min(at_begin, at_end);
  if (key > horizon_) return;
  windows_.push(key, w);
  ++window_count_;
}

/// Whether no shortest path crosses a window, because one of the ends of its half-edge is nearer [XW09].
/// @param r  record of its half-edge
bool Propagation::loses(const Window& w, const HalfRecord& r, double at_begin, double at_end) const {
  return at_end > (distance_[r.tail] + w.end) * slack || at_begin > (distance_[r.head] + r.length - w.begin) * slack;
}

void Propagation::cross_face(const Window& w) {
  const HalfRecord r = surface_.record(w.half);
  const double sigma = origins_[w.origin()].distance;
  const double at_begin = sigma + distance(w.from, {w.begin, 0}), at_end = sigma + distance(w.from, {w.end, 0});
  if (loses(w, r, at_begin, at_end)) return;  // again, as distances may have become shorter since it was queued
  if (has_targets()) offer_targets_of(w);

  const double crossing = crossing_to(w.from, apex(r));
  const double across = crossing - w.from[0], down = -w.from[1];
  const double beside = window_margin * r.length + missed_angle * (across * across + down * down) / down;
  bool left = crossing > w.begin, right = crossing < w.end;
  double to_apex = 0;
  if (crossing > w.begin - beside && crossing < w.end + beside) {
    to_apex = sigma + distance(w.from, apex(r));
    offer(r.apex, to_apex, {w.half, w.from, w.turn, w.origin2}, apex(r));
    // Only one window continues on both sides of the apex: one angle, one split [CH90].
    ApexArrival& best = apex_arrivals_[w.half];
    if (to_apex < best.distance) {
      if (best.distance == infinity) crossed_.push_back(w.half);
      best = {to_apex, crossing};
      if (!apex_arrival_origins_.empty()) apex_arrival_origins_[w.half] = w.from;
    } else if (to_apex > best.distance * slack && std::abs(crossing - best.crossing) > same_ray * r.length) {
      const bool rightwards = crossing < best.crossing;
      if (hides(w, rightwards)) (rightwards ? right : left) = false;
    }
  }
  if (left && r.beyond_left >= 0) continue_left(w, r, sigma, crossing < w.end ? to_apex : 0);
  if (right && r.beyond_right >= 0) continue_right(w, r, sigma, crossing > w.begin ? to_apex : 0);
}

/// Whether all rays of a window to the right (left) of the apex cross the line from the best window's origin to the apex. With
/// several sources, some rays may pass that origin, if it is a source inside the window.
bool Propagation::hides(const Window& w, bool right) const {
  if (apex_arrival_origins_.empty()) return true;
  const ApexArrival& best = apex_arrivals_[w.half];
  const double last = right ? w.end : w.begin;
  const double beyond = cross(Place{last, 0} - w.from, apex_arrival_origins_[w.half] - w.from);
  return right ? last <= best.crossing || beyond < 0 : last >= best.crossing || beyond > 0;
}

/// Queues the part of a window that continues through the side tail-apex.
/// @param to_apex  distance of the apex where the window ends there, otherwise 0
void Propagation::continue_left(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double begin = std::max(0.0, hit_left(r, w.from, w.begin));
  const double end = to_apex > 0 ? r.left : std::min(r.left, hit_left(r, w.from, w.end));
  if (!(end - begin > min_width * r.left)) return;
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

/// Queues the part of a window that continues through the side apex-head.
void Propagation::continue_right(const Window& w, const HalfRecord& r, double sigma, double to_apex) {
  const double begin = to_apex > 0 ? 0 : std::max(0.0, hit_right(r, w.from, w.begin));
  const double end = std::min(r.right, hit_right(r, w.from, w.end));
  if (!(end - begin > min_width * r.right)) return;
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

// ---------------------------------------------------------------------------------------------- run

/// Processes both queues in the order of their buckets, bends first. Ends at the horizon, or when nothing in the queues can
/// reach a target earlier.
void Propagation::run(const Progress& progress) {
  const auto inside = [](const Origin& source) { return source.vertex < 0; };
  if (sources_ > 1 && std::any_of(origins_.begin(), origins_.end(), inside))
    apex_arrival_origins_.resize(apex_arrivals_.size());
  Offset chunks = 0;
  while (!windows_.empty() || !bends_.empty()) {
    progress.step("windows", fraction());
    if (windows_.key() > horizon_) break;
    if (only_targets_) horizon_ = std::min(horizon_, farthest_target());
    if (windows_.key() > horizon_) break;
    if (has_enough_within(windows_.key()) || (max_windows_ > 0 && window_count_ >= max_windows_)) {
      horizon_ = windows_.key();
      break;
    }
    while (!windows_.bucket_empty() || !bends_.bucket_empty()) {
      while (!bends_.bucket_empty()) bends_.drain_chunk([this](const Bend& b) { bend(b); });
      if (windows_.bucket_empty()) continue;
      windows_.drain_chunk([this](const Window& w) { cross_face(w); });
      check_count();
      if (++chunks % 65536 == 0) progress.step("windows", fraction());
    }
    windows_.advance();
    bends_.advance();
  }
  progress.step("windows", 1);
  copy_vertex_targets();
}

bool Propagation::has_enough_within(double distance) const {
  if (max_vertices_ == 0 || std::ssize(touched_) < max_vertices_) return false;
  return std::ranges::count_if(touched_, [&](Index v) { return distance_[v] <= distance; }) >= max_vertices_;
}

void Propagation::check_count() const {
  if (static_cast<double>(window_count_) > max_windows(surface_.face_count()))
    throw InvalidGeometry("windows_without_end", "windows without end: lengths of sides differ too much",
                          "repair the mesh, or use the heat method");
}

/// Calls visit(corner) for the corners around a vertex.
template <class Visit>
void Propagation::for_each_corner(Index vertex, const Visit& visit) const {
  const Corner first = surface_.first_corner(vertex);
  Corner c = first;
  do {
    visit(c);
    c = surface_.turn_left(c);
  } while (c.half >= 0 && c != first);
}

void Propagation::check_reached() const {
  for (const Index from : touched_) {
    const auto check = [&](Index to, double length) {
      const double way = (distance_[from] + length) * (1 + 1e-9);
      if (!(way < horizon_) || distance_[to] <= way) return;
      throw InvalidGeometry(
          "windows_lost",
          "windows were lost before they reached vertex " + std::to_string(to) + ", a neighbor of vertex " +
              std::to_string(from),
          "repair the needle triangles there, or use the polar or the heat method (paths: locally_shortest_path)");
    };
    if (!(distance_[from] < horizon_)) continue;
    for_each_corner(from, [&](Corner c) {
      const HalfRecord& r = surface_.record(c.half);
      check(r.head, r.length);
      check(r.apex, r.left);
    });
  }
}

void Propagation::clear(const ExactOptions& options) {
  for (const Index vertex : touched_) distance_[vertex] = infinity;
  for (const Half half : crossed_) apex_arrivals_[half].distance = infinity;
  touched_.clear();
  crossed_.clear();
  origins_.clear();
  sources_ = 0;
  window_count_ = 0;
  horizon_ = options.radius;
  max_windows_ = options.max_windows;
  max_vertices_ = options.max_vertices;
}

PropagationResult Propagation::found() && {
  const ExactStatistics statistics{window_count_, bytes()};
  return {std::move(distance_),
          std::move(target_distance_),
          std::move(reached_),
          std::move(origins_),
          horizon_,
          statistics};
}

std::size_t Propagation::bytes() const {
  return distance_.capacity() * sizeof(double) + reached_.capacity() * sizeof(ArrivalRecord) +
         origins_.capacity() * sizeof(Origin) + targets_.capacity() * sizeof(Vec2) + windows_.bytes() + bends_.bytes() +
         apex_arrivals_.capacity() * sizeof(ApexArrival) + crossed_.capacity() * sizeof(Half) +
         apex_arrival_origins_.capacity() * sizeof(Place);
}

namespace {

/// A straight piece of a line that would be shorter on the other side of a nearby vertex.
struct Shortcut {
  Bend around;  ///< the vertex
  double gain;  ///< reduction of length, if nothing else is in between
};

/// Reduction of length where a straight piece from a to b moves to the other side of a vertex of its strip; <= 0: none.
double gain_beyond(double angle_sum, const Place& vertex, const Place& a, const Place& b) {
  const Vec2 back = a - vertex, ahead = b - vertex;
  const double here = angle_between(back, ahead), there = angle_sum - here;
  if (!(there < here)) return 0;
  const double p = norm(back), q = norm(ahead), sine = std::sin(there / 2);
  return distance(a, b) - std::sqrt((p - q) * (p - q) + 4 * p * q * sine * sine);
}

/// Collects shortcuts past the vertices on one side of the straight piece before bend `to`.
void collect(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line, std::size_t to, bool left,
             std::vector<Shortcut>& found) {
  const Bend &from = line.bends[to - 1], &next = line.bends[to];
  const std::size_t begin = to == 1 ? 0 : from.leaves + 1;
  const std::size_t end = to + 1 == line.bends.size() ? line.portals.size() : next.arrives;
  const auto vertex_at = [&](std::size_t p) {
    return surface.record(corner_after(strip, line, {{}, left, p, p}, p)).tail;
  };
  for (std::size_t p = begin, last = p; p < end; p = last) {
    const Index vertex = vertex_at(p);
    for (last = p + 1; last < end && vertex_at(last) == vertex;) ++last;
    if (surface.on_boundary(vertex)) continue;
    const Place at = left ? line.portals[p].left : line.portals[p].right;
    const double gain = gain_beyond(surface.angle_sum(vertex), at, from.at, next.at);
    if (gain > 1e-12 * line.length) found.push_back({{at, left, p, last - 1}, gain});
  }
}

std::vector<Shortcut> shortcuts(const PolyhedralSurface& surface, const Strip& strip, const TautLine& line) {
  std::vector<Shortcut> found;
  for (std::size_t to = 1; to < line.bends.size(); ++to)
    for (bool left : {true, false}) collect(surface, strip, line, to, left, found);
  std::stable_sort(found.begin(), found.end(), [](const Shortcut& a, const Shortcut& b) { return a.gain > b.gain; });
  return found;
}

}  // namespace

TautLine pass_other_side(const PolyhedralSurface& surface, Strip& strip, TautLine line) {
  constexpr std::size_t max_tries = 8;
  for (bool shorter = true; shorter;) {
    shorter = false;
    std::vector<Shortcut> found = shortcuts(surface, strip, line);
    if (found.size() > max_tries) found.resize(max_tries);
    for (const Shortcut& shortcut : found) {
      const auto around = other_side(surface, strip, line, shortcut.around);
      if (!around) continue;
      Strip other{strip.start, strip.end, {}};
      const auto at = [&](std::size_t p) { return strip.entered.begin() + static_cast<std::ptrdiff_t>(p); };
      for (auto h = strip.entered.begin(); h != at(shortcut.around.arrives); ++h) enter(surface, other.entered, *h);
      for (Half h : *around) enter(surface, other.entered, h);
      for (auto h = at(shortcut.around.leaves + 1); h != strip.entered.end(); ++h) enter(surface, other.entered, *h);
      TautLine beyond = shorten(surface, other);
      if (!(beyond.length < line.length * (1 - 1e-14))) continue;
      strip = std::move(other);
      line = std::move(beyond);
      shorter = true;
      break;
    }
  }
  return line;
}

}  // namespace ahm::exact
