#include "propagation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ahm/error.hpp"
#include "check_point.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

/// Many times what has been seen of any mesh, and no less than the bound of [MMP87]. Windows beyond run in circles, where
/// lengths are below the rounding of distances.
double most_windows(double faces) { return 1e6 + faces * faces; }

}  // namespace

Propagation::Propagation(const PolyhedralSurface& surface, const ExactOptions& options,
                         std::span<const MeshPoint> targets)
    : surface_(surface),
      horizon_(options.radius),
      only_targets_(options.only_targets),
      most_windows_(options.most_windows),
      distance_(static_cast<std::size_t>(surface.vertex_count()), infinity),
      target_distance_(targets.size(), infinity),
      reached_(distance_.size() + targets.size()) {
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
  // The sides of the face that the source sees at an angle; those it lies on, within rounding, it sees through.
  Ray ray{first, surface_.place(point), 0, origin2};
  for (int s = 0; s < 3; ++s) {
    const HalfRecord& r = surface_.record(ray.half);
    offer(r.apex, distance(ray.from, apex(r)), ray, apex(r));
    if ((zeros == 1 && s == zero) || on_line(exact::beyond_right(r, ray.from), r.right))
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
  start(w);
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

// ---------------------------------------------------------------------------------------------- what is reached

Reached Propagation::reach(const Ray& ray, const Place& at) const {
  const auto origin = static_cast<Index>(ray.origin2 / 2);
  if (ray.origin2 / 2 >= sources_) return {ray.half, origin, ray.from, origins_[origin].direction};
  const double angle = std::atan2(at[1] - ray.from[1], at[0] - ray.from[0]);
  return {ray.half, origin, ray.from, ray.turn + (ray.origin2 & 1 ? -angle : angle)};
}

/// Offers straight ways to all targets in the face that a ray starts in.
void Propagation::see_face(const Ray& ray) {
  if (!has_targets()) return;
  see_targets(
      ray.half, ray.from, origins_[ray.origin2 / 2].distance, [](const Place&) { return true; },
      [&](const Place& at) { return reach(ray, at); }, [&](const Place&) { return origin_error(ray.origin2 / 2); });
}

void Propagation::copy_vertex_targets() {
  for (std::size_t k = 0; k < target_vertex_.size(); ++k) {
    if (target_vertex_[k] < 0) continue;
    target_distance_[k] = distance_[target_vertex_[k]];
    reached_[distance_.size() + k] = reached_[target_vertex_[k]];
  }
}

void Propagation::check_count() const {
  if (static_cast<double>(made_) > most_windows(surface_.face_count()))
    throw InvalidGeometry("windows_without_end", "windows without end: lengths of sides differ too much",
                          "repair the mesh, or use heat");
}

Found Propagation::found() && {
  const ExactStatistics statistics{made_, bytes()};
  return {std::move(distance_),
          std::move(target_distance_),
          std::move(reached_),
          std::move(origins_),
          horizon_,
          statistics};
}

std::size_t Propagation::bytes() const {
  return distance_.capacity() * sizeof(double) + reached_.capacity() * sizeof(Reached) +
         origins_.capacity() * sizeof(Origin) + targets_.capacity() * sizeof(Vec2);
}

}  // namespace ahm::exact
