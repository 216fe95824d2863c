#include "merged_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ahm::exact {
namespace {

using std::numbers::pi;

constexpr std::uint32_t none = ~0u;
/// Rays at a smaller angle, in radians, are one.
constexpr double same_ray = 1e-15;

/// Whether the ray of an origin through t on the half-edge goes on to the left of that of another one.
bool opens_left(const Place& from, const Place& other, double t) {
  const Vec2 ray{t - from[0], -from[1]}, beside{t - other[0], -other[1]};
  return cross(beside, ray) > same_ray * norm(ray) * norm(beside);
}

/// What the way by which a piece reaches p lacks, where that lies beyond its own rays.
double lacking(const FrontPiece& piece, const Place& p) {
  const double crossing = crossing_to(piece.from, p);
  const double t = std::clamp(crossing, piece.begin, piece.end);
  return t == crossing ? 0.0 : detour(piece.from, t, p);
}

/// In the frame of a half-edge that runs the other way, seen in a mirror.
void turn_over(FrontPiece& piece, double length) {
  const double begin = piece.begin;
  piece.begin = length - piece.end;
  piece.end = length - begin;
  piece.from[0] = length - piece.from[0];
  piece.turn += piece.gain * pi;
  piece.gain = -piece.gain;
}

}  // namespace

MergedPropagation::MergedPropagation(const PolyhedralSurface& surface, const ExactOptions& options,
                                     std::span<const MeshPoint> targets)
    : Propagation(surface, options, targets),
      tolerance_(2 * options.tolerance),
      upper_(distance_.size() + targets.size(), infinity),
      lists_(3 * static_cast<std::size_t>(surface.face_count()), Lists{none, none, infinity}),
      free_(none),
      waiting_(bucket_width * surface.mean_length()),
      turns_(bucket_width * surface.mean_length()),
      leaving_(bucket_width * surface.mean_length()) {}

// ---------------------------------------------------------------------------------------------- origins

void MergedPropagation::start(const Window& w) {
  const Origin& origin = origins_[w.origin()];
  FrontPiece piece{w.begin,
                   w.end,
                   w.from,
                   origin.distance,
                   origin_error(w.origin()),
                   origin.direction,
                   0,
                   static_cast<std::uint32_t>(w.origin()),
                   none};
  if (w.origin() < sources_) {
    piece.turn = w.turn;
    piece.gain = w.mirrored() ? -1 : 1;
  }
  wait(w.half, piece);
}

void MergedPropagation::nearer(std::size_t row, double distance, double error) {
  upper_[row] = std::min(upper_[row], distance + error);
  if (row < distance_.size() && distance <= horizon_) turns_.push(distance, {static_cast<Index>(row), distance});
}

/// Lights all faces about a vertex from there.
void MergedPropagation::turn(const Turn& event) {
  const Index v = event.vertex;
  if (event.distance > distance_[v]) return;
  const Reached& in = reached_[v];
  const auto origin2 = static_cast<std::uint32_t>(2 * origins_.size());
  origins_.push_back({v, origins_[in.origin].source, event.distance, in.direction});
  origin_error_.push_back(upper_[v] - event.distance);
  const Corner first = surface_.first_corner(v);
  Corner c = first;
  do {
    light_corner({c.half, {}, 0, origin2}, 0, surface_.angle(c.half));
    c = surface_.turn_left(c);
  } while (c.half >= 0 && c != first);
}

// ---------------------------------------------------------------------------------------------- half-edges

std::uint32_t MergedPropagation::take(const FrontPiece& piece) {
  if (free_ == none) {
    pool_.push_back(piece);
    return static_cast<std::uint32_t>(pool_.size() - 1);
  }
  const std::uint32_t taken = free_;
  free_ = pool_[taken].next;
  pool_[taken] = piece;
  return taken;
}

void MergedPropagation::give_back(std::uint32_t piece) {
  pool_[piece].next = free_;
  free_ = piece;
}

/// Whether no shortest path crosses a piece, since one of the ends of the half-edge is nearer [XW09].
bool MergedPropagation::loses(const HalfRecord& r, const FrontPiece& piece) const {
  return piece.at(piece.end) > (upper_[r.tail] + piece.end) * slack ||
         piece.at(piece.begin) > (upper_[r.head] + r.length - piece.begin) * slack;
}

void MergedPropagation::wait(Half half, const FrontPiece& piece) {
  const HalfRecord& r = surface_.record(half);
  if (!(piece.end - piece.begin > least_width * r.length) || on_line(piece.from, r.length) || loses(r, piece)) return;
  const double key = piece.lowest();
  if (key > horizon_) return;
  Lists& lists = lists_[half];
  const std::uint32_t taken = take(piece);
  pool_[taken].next = lists.waiting;
  lists.waiting = taken;
  if (key < lists.key) {
    lists.key = key;
    waiting_.push(key, {half, key});
  }
}

void MergedPropagation::cross_side(const Side& event) {
  if (event.key != lists_[event.half].key) return;
  forget_passed();
  if (lists_[event.half].passed == none) leaving_.push(event.key, event.half);
  gather(event);
  profile_.merge({tolerance_, origins_, full_angle_});
  keep(event.half);
  for (std::size_t k = 0; k < profile_.entries().size(); ++k)
    if (profile_.entries()[k].fresh) cross_face(event.half, k);
}

/// Takes all pieces of a half-edge out of the pool, those that wait being fresh.
void MergedPropagation::gather(const Side& event) {
  const HalfRecord& r = surface_.record(event.half);
  Lists& lists = lists_[event.half];
  lists.key = infinity;
  profile_.clear(r.length);
  for (std::uint32_t k = std::exchange(lists.passed, none); k != none;) {
    profile_.add_passed(pool_[k]);
    const std::uint32_t next = pool_[k].next;
    give_back(k);
    k = next;
  }
  for (std::uint32_t k = std::exchange(lists.waiting, none); k != none;) {
    if (!loses(r, pool_[k])) profile_.insert(pool_[k]);
    const std::uint32_t next = pool_[k].next;
    give_back(k);
    k = next;
  }
  profile_.drop_fresh_if([&](const FrontPiece& piece) { return loses(r, piece); });
  profile_.close_gaps();
}

/// Forgets pieces that have passed where all that come will lose to one of the ends of their half-edge.
void MergedPropagation::forget_passed() {
  for (; leaving_.key() < waiting_.key(); leaving_.advance())
    while (!leaving_.bucket_empty()) leaving_.drain_chunk([this](Half half) { leave(half); });
}

void MergedPropagation::leave(Half half) {
  const HalfRecord& r = surface_.record(half);
  const double now = leaving_.key(), near = std::min(upper_[r.tail], upper_[r.head]);
  const double last = (near < infinity ? near + r.length : now + r.length) * slack;
  if (now < last) return leaving_.push(last + 2 * bucket_width * surface_.mean_length(), half);
  for (std::uint32_t k = std::exchange(lists_[half].passed, none); k != none;) {
    const std::uint32_t next = pool_[k].next;
    give_back(k);
    k = next;
  }
}

void MergedPropagation::keep(Half half) {
  const auto entries = profile_.entries();
  for (std::size_t k = entries.size(); k-- > 0;) {
    const std::uint32_t taken = take(entries[k].piece);
    pool_[taken].next = lists_[half].passed;
    lists_[half].passed = taken;
  }
}

// ---------------------------------------------------------------------------------------------- faces

/// Whether the rays of a piece may be taken to go on to that of another origin through its end t.
bool MergedPropagation::extends(const FrontPiece& piece, double t, const Place& ray, double reach) const {
  const Place away = Place{t, 0} - ray;
  const Place far = Place{t, 0} + (reach / norm(away)) * away;
  return piece.error + detour(piece.from, t, far) <= tolerance_ * piece.lowest();
}

/// A fresh piece goes on through the face, and what lies between its rays and those of the neighbours it touches is lit:
/// at the right end by this piece, at the left one if the neighbour there is not fresh and has not done it.
void MergedPropagation::cross_face(Half half, std::size_t entry) {
  const auto entries = profile_.entries();
  const FrontPiece piece = entries[entry].piece;
  const HalfRecord& r = surface_.record(half);
  const double reach = r.length + std::max(r.left, r.right);
  Rays rays{piece.from, piece.from};
  const auto origin_at = [&](double t, const Place& first, const Place& last) {
    FrontPiece point = piece;
    point.begin = point.end = t;
    point.from = {t, 0};
    point.sigma = piece.at(t);
    point.turn = piece.direction(t);
    point.gain = 0;
    go_on(half, point, {first, last});
  };
  if (entry > 0 && !entries[entry - 1].fresh && entries[entry - 1].piece.end == piece.begin) {
    const FrontPiece& left = entries[entry - 1].piece;
    if (opens_left(left.from, piece.from, piece.begin)) {
      if (extends(piece, piece.begin, left.from, reach))
        rays.first = left.from;
      else
        origin_at(piece.begin, left.from, piece.from);
    }
  }
  if (entry + 1 < entries.size() && entries[entry + 1].piece.begin == piece.end) {
    const FrontPiece& right = entries[entry + 1].piece;
    if (opens_left(piece.from, right.from, piece.end)) {
      if (extends(piece, piece.end, right.from, reach))
        rays.last = right.from;
      else
        origin_at(piece.end, piece.from, right.from);
    }
  }
  go_on(half, piece, rays);
}

/// Goes on through a face between two rays through the ends of a piece.
void MergedPropagation::go_on(Half half, const FrontPiece& piece, const Rays& rays) {
  ++made_;
  const HalfRecord& r = surface_.record(half);
  if (has_targets()) see_targets_of(half, piece, rays);
  const double first = crossing_to(rays.first, apex(r)), last = crossing_to(rays.last, apex(r));
  const double beside = window_margin * r.length;
  if (first > piece.begin - beside && last < piece.end + beside) see_apex(half, piece);
  if (first > piece.begin && r.beyond_left >= 0) go_left(half, piece, rays, last < piece.end);
  if (last < piece.end && r.beyond_right >= 0) go_right(half, piece, rays, first > piece.begin);
}

void MergedPropagation::see_apex(Half half, const FrontPiece& piece) {
  const HalfRecord& r = surface_.record(half);
  const double d = piece.sigma + distance(piece.from, apex(r));
  if (!shorten(r.apex, d)) return;
  reached_[r.apex] = reached_by(half, piece, apex(r));
  nearer(static_cast<std::size_t>(r.apex), d, piece.error + lacking(piece, apex(r)));
}

void MergedPropagation::go_left(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex) {
  const HalfRecord& r = surface_.record(half);
  FrontPiece child = piece;
  child.begin = std::max(0.0, hit_left(r, rays.first, piece.begin));
  child.end = to_apex ? r.left : std::min(r.left, hit_left(r, rays.last, piece.end));
  if (!(child.end - child.begin > least_width * r.left)) return;
  child.from = beyond_left(r, piece.from);
  if (child.at(child.begin) > (upper_[r.head] + distance({r.length, 0}, on_left(r, child.begin))) * slack) return;
  if (rays.first != piece.from || rays.last != piece.from)
    child.error += std::max(lacking(piece, on_left(r, child.begin)), lacking(piece, on_left(r, child.end)));
  child.turn += piece.gain * surface_.angle(half);
  if (r.mirrored & 1) turn_over(child, r.left);
  wait(r.beyond_left, child);
}

void MergedPropagation::go_right(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex) {
  const HalfRecord& r = surface_.record(half);
  FrontPiece child = piece;
  child.begin = to_apex ? 0 : std::max(0.0, hit_right(r, rays.first, piece.begin));
  child.end = std::min(r.right, hit_right(r, rays.last, piece.end));
  if (!(child.end - child.begin > least_width * r.right)) return;
  child.from = exact::beyond_right(r, piece.from);
  if (child.at(child.end) > (upper_[r.tail] + distance({0, 0}, on_right(r, child.end))) * slack) return;
  if (rays.first != piece.from || rays.last != piece.from)
    child.error += std::max(lacking(piece, on_right(r, child.begin)), lacking(piece, on_right(r, child.end)));
  child.turn -= piece.gain * surface_.angle(next(half));
  if (r.mirrored & 2) turn_over(child, r.right);
  wait(r.beyond_right, child);
}

// ---------------------------------------------------------------------------------------------- what is reached

Reached MergedPropagation::reached_by(Half half, const FrontPiece& piece, const Place& at) const {
  double direction = piece.turn;
  if (piece.gain != 0) direction += piece.gain * std::atan2(at[1] - piece.from[1], at[0] - piece.from[0]);
  const Index source = origins_[piece.origin].source;
  if (std::isfinite(full_angle_[source]))
    direction -= full_angle_[source] * std::floor(direction / full_angle_[source]);
  return {half, static_cast<Index>(piece.origin), piece.from, direction};
}

void MergedPropagation::see_targets_of(Half half, const FrontPiece& piece, const Rays& rays) {
  const double margin = window_margin * surface_.record(half).length;
  see_targets(
      half, piece.from, piece.sigma,
      [&](const Place& at) {
        return crossing_to(rays.first, at) > piece.begin - margin && crossing_to(rays.last, at) < piece.end + margin;
      },
      [&](const Place& at) { return reached_by(half, piece, at); },
      [&](const Place& at) { return piece.error + lacking(piece, at); });
}

double MergedPropagation::farthest_target() {
  double farthest = 0;
  for (std::size_t k = 0; k < target_vertex_.size(); ++k)
    farthest = std::max(farthest, upper_[target_vertex_[k] >= 0 ? target_vertex_[k] : distance_.size() + k]);
  return farthest;
}

void MergedPropagation::set_full_angles() {
  for (std::size_t k = 0; k < sources_; ++k) {
    const Index v = origins_[k].vertex;
    full_angle_.push_back(v < 0 ? 2 * pi : surface_.on_boundary(v) ? infinity : surface_.angle_sum(v));
    if (v >= 0) upper_[v] = 0;
  }
}

void MergedPropagation::run(const Progress& progress) {
  set_full_angles();
  drain(
      turns_, [this](const Turn& t) { turn(t); }, waiting_, [this](const Side& s) { cross_side(s); }, progress);
  finish();
  progress.step("windows", 1);
}

/// True distances lie between those found and their upper bounds.
void MergedPropagation::finish() {
  for (std::size_t v = 0; v < distance_.size(); ++v) distance_[v] = 0.5 * (distance_[v] + upper_[v]);
  for (std::size_t k = 0; k < target_distance_.size(); ++k)
    target_distance_[k] = 0.5 * (target_distance_[k] + upper_[distance_.size() + k]);
  copy_vertex_targets();
}

std::size_t MergedPropagation::bytes() const {
  return Propagation::bytes() + waiting_.bytes() + turns_.bytes() + leaving_.bytes() +
         lists_.capacity() * sizeof(Lists) + pool_.capacity() * sizeof(FrontPiece) + upper_.capacity() * sizeof(double);
}

}  // namespace ahm::exact
