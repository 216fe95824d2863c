#include "exact/merged_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace ahm::exact {
namespace {

/// Relative to the side: minimum width of a piece, below which its neighbor replaces it, and accuracy of the position where two
/// pieces are equal.
constexpr double min_piece_width = 1e-11, crossing_width = 1e-10;
/// Relative rounding error of distances.
constexpr double rounding = 1e-14;
/// Maximum number of steps. Every third one bisects the interval, so that it also ends where distances bend sharply.
constexpr int crossing_steps = 120;

/// Where the rays of two pieces are parallel, and the difference of their distances is extremal; NaN or infinite: nowhere.
double parallel(const FrontPiece& a, const FrontPiece& b) {
  return (a.from[0] * b.from[1] - b.from[0] * a.from[1]) / (b.from[1] - a.from[1]);
}

}  // namespace

double FrontPiece::lowest() const {
  return from[0] >= begin && from[0] <= end ? sigma - from[1] : std::min(at(begin), at(end));
}

double highest_difference(const FrontPiece& a, const FrontPiece& b, double begin, double end) {
  const double t = parallel(a, b), ends = std::max(a.at(begin) - b.at(begin), a.at(end) - b.at(end));
  return t > begin && t < end ? std::max(ends, a.at(t) - b.at(t)) : ends;
}

void FrontProfile::emit(const Entry& entry, double begin, double end) {
  if (!(end > begin)) return;
  if (!out_.empty() && out_.back().piece.end == begin) {
    FrontPiece& last = out_.back().piece;
    const bool same = out_.back().fresh == entry.fresh && last.from == entry.piece.from &&
                      last.sigma == entry.piece.sigma && last.turn == entry.piece.turn;
    if (same || end - begin < min_piece_width * length_) {
      last.end = end;
      return;
    }
  }
  out_.push_back(entry);
  out_.back().piece.begin = begin;
  out_.back().piece.end = end;
}

/// Where two pieces have equal distances. One of them must be lower at one end of the interval, the other at the other end. By
/// regula falsi (Illinois).
double FrontProfile::crossing(const FrontPiece& a, const FrontPiece& b, double low, double high) const {
  double at_low = a.at(low) - b.at(low), at_high = a.at(high) - b.at(high);
  int side = 0;
  for (int k = 0; k < crossing_steps && high - low > crossing_width * length_; ++k) {
    double t = (low * at_high - high * at_low) / (at_high - at_low);
    if (k % 3 == 2 || !(t > low && t < high)) t = 0.5 * (low + high);
    const double value = a.at(t), difference = value - b.at(t);
    if (std::abs(difference) < 0.1 * rounding * value) return t;
    if ((difference < 0) == (at_low < 0)) {
      low = t, at_low = difference;
      if (std::exchange(side, -1) == -1) at_high /= 2;
    } else {
      high = t, at_high = difference;
      if (std::exchange(side, 1) == 1) at_low /= 2;
    }
  }
  return 0.5 * (low + high);
}

/// Emits the lower of two pieces over an interval that both cover; where they are equal, the holder.
void FrontProfile::contest(const Entry& challenger, const Entry& holder, double begin, double end) {
  const FrontPiece &a = challenger.piece, &b = holder.piece;
  const double equal = rounding * (std::abs(a.sigma) + std::abs(a.from[0]) + std::abs(a.from[1]) + length_);
  const double middle = parallel(a, b);
  const bool two = middle > begin && middle < end;
  const double stops[3] = {begin, two ? middle : end, end};
  for (int k = 0; k < (two ? 2 : 1); ++k) {
    const double low = stops[k], high = stops[k + 1];
    const double at_low = a.at(low) - b.at(low), at_high = a.at(high) - b.at(high);
    const bool wins_low = at_low < -equal, wins_high = at_high < -equal;
    if (wins_low == wins_high || (at_low >= 0) == (at_high >= 0)) {
      emit(wins_low || wins_high ? challenger : holder, low, high);
      continue;
    }
    const double t = crossing(a, b, low, high);
    emit(wins_low ? challenger : holder, low, t);
    emit(wins_low ? holder : challenger, t, high);
  }
}

void FrontProfile::insert(const FrontPiece& piece) {
  const Entry entry{piece, true};
  double done = piece.begin;
  out_.clear();
  for (const Entry& e : entries_) {
    const FrontPiece& p = e.piece;
    if (p.end <= piece.begin) {
      out_.push_back(e);
      continue;
    }
    emit(entry, done, std::min(p.begin, piece.end));
    if (p.begin >= piece.end) {
      done = piece.end;
      out_.push_back(e);
      continue;
    }
    emit(e, p.begin, piece.begin);
    contest(entry, e, std::max(p.begin, piece.begin), std::min(p.end, piece.end));
    emit(e, piece.end, p.end);
    done = std::min(p.end, piece.end);
  }
  emit(entry, done, piece.end);
  std::swap(entries_, out_);
}

namespace {

/// Maximum number of pieces that are merged at once.
constexpr std::size_t max_run = 12;
/// Pieces whose directions at the source differ by more than this, in radians, are not merged.
constexpr double max_direction_jump = 0.05;
/// Maximum distance of a merged piece's origin, relative to the distances and the width of the piece.
constexpr double max_origin_ratio = 1e4;
/// Gaps between pieces that are only rounding, relative to the side.
constexpr double closed_gap = 1e-9;

using Run = std::span<const FrontProfile::Entry>;

/// The ends of a piece over [begin, begin + width], with fixed distances at both. Its functions compute the distance of the
/// piece's origin from the first end.
struct Ends {
  double begin, width, at_begin, rise;

  /// The origin for which the distance at t equals `value`; nearer origins have smaller distances there.
  double through(double t, double value) const {
    const double along = t - begin, up = value - at_begin, bend = rise / width - up / along;
    if (!(bend > 0)) return std::numeric_limits<double>::infinity();
    return 0.5 * (width - rise * rise / width - along + up * up / along) / bend;
  }
  double with_slope_at_begin(double slope) const {
    const double bend = rise - slope * width;
    return bend > 0 ? (width * width - rise * rise) / (2 * bend) : std::numeric_limits<double>::infinity();
  }
  double with_slope_at_end(double slope) const {
    const double bend = slope * width - rise;
    return bend > 0 ? (width * width - rise * rise) / (2 * bend) - rise : std::numeric_limits<double>::infinity();
  }
};

/// The piece whose distances agree with a run at both ends and are no higher in between.
std::optional<FrontPiece> below(Run run) {
  const FrontPiece &first = run.front().piece, &last = run.back().piece;
  const double at_begin = first.at(first.begin), at_end = last.at(last.end);
  const Ends ends{first.begin, last.end - first.begin, at_begin, at_end - at_begin};
  if (!(std::abs(ends.rise) < ends.width)) return {};
  double near = max_origin_ratio * (at_begin + at_end + ends.width);
  near = std::min(
      {near, ends.with_slope_at_begin(first.slope(first.begin)), ends.with_slope_at_end(last.slope(last.end))});
  for (std::size_t k = 0; k + 1 < run.size(); ++k) {
    const double t = run[k].piece.end;
    near = std::min(near, ends.through(t, std::min(run[k].piece.at(t), run[k + 1].piece.at(t))));
  }
  if (!(near > 0) || !(near + ends.rise > 0)) return {};
  const double far = near + ends.rise;
  const double x = (ends.width * ends.width + near * near - far * far) / (2 * ends.width), y2 = near * near - x * x;
  if (!(y2 > 0)) return {};
  FrontPiece piece = first;
  piece.end = last.end;
  piece.from = {first.begin + x, -std::sqrt(y2)};
  piece.sigma = at_begin - near;
  double over = 0;
  for (const auto& [old, fresh] : run) over = std::max(over, highest_difference(piece, old, old.begin, old.end));
  if (over > 1e-13 * (at_begin + at_end + near)) return {};
  piece.sigma -= over;
  return piece;
}

/// Sets directions that agree with a run at both ends and follow the angle of the ray in between. Returns false where the
/// directions of the run jump.
bool set_directions(Run run, double full_angle, FrontPiece& piece) {
  const double start = run.front().piece.direction(run.front().piece.begin);
  double end = start;
  for (const auto& [old, fresh] : run) {
    double jump = old.direction(old.begin) - end;
    if (std::isfinite(full_angle)) jump -= full_angle * std::round(jump / full_angle);
    if (std::abs(jump) > max_direction_jump) return false;
    end += jump + old.direction(old.end) - old.direction(old.begin);
  }
  const double low = std::atan2(-piece.from[1], piece.begin - piece.from[0]);
  const double high = std::atan2(-piece.from[1], piece.end - piece.from[0]);
  piece.gain = low > high ? (end - start) / (high - low) : 0;
  piece.turn = start - piece.gain * low;
  return true;
}

}  // namespace

std::optional<FrontPiece> merged(Run run, const MergeRules& rules) {
  const Index source = rules.origins[run.front().piece.origin].source;
  const auto wider = [](const auto& a, const auto& b) {
    return a.piece.end - a.piece.begin < b.piece.end - b.piece.begin;
  };
  const FrontPiece& widest = std::max_element(run.begin(), run.end(), wider)->piece;
  for (const auto& [old, fresh] : run)
    if (rules.origins[old.origin].source != source) return {};
  std::optional<FrontPiece> piece = below(run);
  if (!piece) return {};
  piece->error = 0;
  for (const auto& [old, fresh] : run)
    piece->error = std::max(piece->error, old.error + highest_difference(old, *piece, old.begin, old.end));
  if (!(piece->error <= rules.tolerance * piece->lowest())) return {};
  if (!set_directions(run, rules.full_angle[source], *piece)) return {};
  piece->origin = widest.origin;
  return piece;
}

void FrontProfile::close_gaps() {
  for (std::size_t k = 0; k + 1 < entries_.size(); ++k) {
    FrontPiece& next = entries_[k + 1].piece;
    const double end = entries_[k].piece.end;
    if (next.begin - end < closed_gap * length_) next.begin = end;
  }
}

void FrontProfile::merge(const MergeRules& rules) {
  out_.clear();
  for (std::size_t k = 0; k < entries_.size();) {
    Entry best = entries_[k];
    std::size_t end = k + 1;
    while (best.fresh && end < entries_.size() && entries_[end].fresh && end - k < max_run &&
           entries_[end].piece.begin == entries_[end - 1].piece.end) {
      const std::optional<FrontPiece> one = merged(std::span(entries_).subspan(k, end + 1 - k), rules);
      if (!one) break;
      best.piece = *one;
      ++end;
    }
    out_.push_back(best);
    k = end;
  }
  std::swap(entries_, out_);
}

namespace {

using std::numbers::pi;

constexpr std::uint32_t none = ~0u;
/// Rays at a smaller angle than this, in radians, are treated as one.
constexpr double same_ray = 1e-15;

/// Whether the ray from an origin through t on the half-edge continues to the left of the ray from another origin.
bool is_left_of(const Place& from, const Place& other, double t) {
  const Vec2 ray{t - from[0], -from[1]}, beside{t - other[0], -other[1]};
  return cross(beside, ray) > same_ray * norm(ray) * norm(beside);
}

/// How much the distance of p by a piece is too short, where p lies outside the rays of the piece.
double missing_length(const FrontPiece& piece, const Place& p) {
  const double crossing = crossing_to(piece.from, p);
  const double t = std::clamp(crossing, piece.begin, piece.end);
  return t == crossing ? 0.0 : detour(piece.from, t, p);
}

/// Converts a piece to the frame of the reversed half-edge, mirrored.
void mirror_piece(FrontPiece& piece, double length) {
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
      half_edges_to_clear_(bucket_width * surface.mean_length()) {}

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

/// Makes a vertex an origin, and lights all faces around it from there.
void MergedPropagation::turn(const Turn& event) {
  const Index v = event.vertex;
  if (event.distance > distance_[v]) return;
  const ArrivalRecord& in = reached_[v];
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

/// Whether no shortest path crosses a piece, because one of the ends of the half-edge is nearer [XW09].
bool MergedPropagation::loses(const HalfRecord& r, const FrontPiece& piece) const {
  return piece.at(piece.end) > (upper_[r.tail] + piece.end) * slack ||
         piece.at(piece.begin) > (upper_[r.head] + r.length - piece.begin) * slack;
}

void MergedPropagation::wait(Half half, const FrontPiece& piece) {
  const HalfRecord& r = surface_.record(half);
  if (!(piece.end - piece.begin > min_width * r.length) || on_line(piece.from, r.length) || loses(r, piece)) return;
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
  discard_passed();
  if (lists_[event.half].passed == none) half_edges_to_clear_.push(event.key, event.half);
  gather(event);
  profile_.merge({tolerance_, origins_, full_angle_});
  keep(event.half);
  for (std::size_t k = 0; k < profile_.entries().size(); ++k)
    if (profile_.entries()[k].fresh) cross_face(event.half, k);
}

/// Moves all pieces of a half-edge from the pool to the profile. The waiting ones are fresh.
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

/// Discards passed pieces of half-edges where every later piece loses to one of the ends.
void MergedPropagation::discard_passed() {
  for (; half_edges_to_clear_.key() < waiting_.key(); half_edges_to_clear_.advance())
    while (!half_edges_to_clear_.bucket_empty()) half_edges_to_clear_.drain_chunk([this](Half half) { leave(half); });
}

void MergedPropagation::leave(Half half) {
  const HalfRecord& r = surface_.record(half);
  const double now = half_edges_to_clear_.key(), near = std::min(upper_[r.tail], upper_[r.head]);
  const double last = (near < infinity ? near + r.length : now + r.length) * slack;
  if (now < last) return half_edges_to_clear_.push(last + 2 * bucket_width * surface_.mean_length(), half);
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

/// Whether a piece may be extended to the ray of another origin through its end t, within the tolerance.
bool MergedPropagation::extends(const FrontPiece& piece, double t, const Place& ray, double reach) const {
  const Place away = Place{t, 0} - ray;
  const Place far = Place{t, 0} + (reach / norm(away)) * away;
  return piece.error + detour(piece.from, t, far) <= tolerance_ * piece.lowest();
}

/// Continues a fresh piece through the face, and lights the gaps between its rays and those of adjacent pieces. This piece
/// lights the gap at its right end, and the gap at its left end only if the piece there is not fresh.
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
    continue_piece(half, point, {first, last});
  };
  if (entry > 0 && !entries[entry - 1].fresh && entries[entry - 1].piece.end == piece.begin) {
    const FrontPiece& left = entries[entry - 1].piece;
    if (is_left_of(left.from, piece.from, piece.begin)) {
      if (extends(piece, piece.begin, left.from, reach))
        rays.first = left.from;
      else
        origin_at(piece.begin, left.from, piece.from);
    }
  }
  if (entry + 1 < entries.size() && entries[entry + 1].piece.begin == piece.end) {
    const FrontPiece& right = entries[entry + 1].piece;
    if (is_left_of(piece.from, right.from, piece.end)) {
      if (extends(piece, piece.end, right.from, reach))
        rays.last = right.from;
      else
        origin_at(piece.end, piece.from, right.from);
    }
  }
  continue_piece(half, piece, rays);
}

/// Continues a piece through a face, between two rays through the ends of the piece.
void MergedPropagation::continue_piece(Half half, const FrontPiece& piece, const Rays& rays) {
  ++window_count_;
  const HalfRecord& r = surface_.record(half);
  if (has_targets()) offer_targets_of(half, piece, rays);
  const double first = crossing_to(rays.first, apex(r)), last = crossing_to(rays.last, apex(r));
  const double beside = window_margin * r.length;
  if (first > piece.begin - beside && last < piece.end + beside) offer_apex(half, piece);
  if (first > piece.begin && r.beyond_left >= 0) continue_left(half, piece, rays, last < piece.end);
  if (last < piece.end && r.beyond_right >= 0) continue_right(half, piece, rays, first > piece.begin);
}

void MergedPropagation::offer_apex(Half half, const FrontPiece& piece) {
  const HalfRecord& r = surface_.record(half);
  const double d = piece.sigma + distance(piece.from, apex(r));
  if (!shorten(r.apex, d)) return;
  reached_[r.apex] = reached_by(half, piece, apex(r));
  nearer(static_cast<std::size_t>(r.apex), d, piece.error + missing_length(piece, apex(r)));
}

void MergedPropagation::continue_left(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex) {
  const HalfRecord& r = surface_.record(half);
  FrontPiece child = piece;
  child.begin = std::max(0.0, hit_left(r, rays.first, piece.begin));
  child.end = to_apex ? r.left : std::min(r.left, hit_left(r, rays.last, piece.end));
  if (!(child.end - child.begin > min_width * r.left)) return;
  child.from = beyond_left(r, piece.from);
  if (child.at(child.begin) > (upper_[r.head] + distance({r.length, 0}, on_left(r, child.begin))) * slack) return;
  if (rays.first != piece.from || rays.last != piece.from)
    child.error +=
        std::max(missing_length(piece, on_left(r, child.begin)), missing_length(piece, on_left(r, child.end)));
  child.turn += piece.gain * surface_.angle(half);
  if (r.mirrored & 1) mirror_piece(child, r.left);
  wait(r.beyond_left, child);
}

void MergedPropagation::continue_right(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex) {
  const HalfRecord& r = surface_.record(half);
  FrontPiece child = piece;
  child.begin = to_apex ? 0 : std::max(0.0, hit_right(r, rays.first, piece.begin));
  child.end = std::min(r.right, hit_right(r, rays.last, piece.end));
  if (!(child.end - child.begin > min_width * r.right)) return;
  child.from = exact::beyond_right(r, piece.from);
  if (child.at(child.end) > (upper_[r.tail] + distance({0, 0}, on_right(r, child.end))) * slack) return;
  if (rays.first != piece.from || rays.last != piece.from)
    child.error +=
        std::max(missing_length(piece, on_right(r, child.begin)), missing_length(piece, on_right(r, child.end)));
  child.turn -= piece.gain * surface_.angle(next(half));
  if (r.mirrored & 2) mirror_piece(child, r.right);
  wait(r.beyond_right, child);
}

// ---------------------------------------------------------------------------------------------- results

ArrivalRecord MergedPropagation::reached_by(Half half, const FrontPiece& piece, const Place& at) const {
  double direction = piece.turn;
  if (piece.gain != 0) direction += piece.gain * std::atan2(at[1] - piece.from[1], at[0] - piece.from[0]);
  const Index source = origins_[piece.origin].source;
  if (std::isfinite(full_angle_[source]))
    direction -= full_angle_[source] * std::floor(direction / full_angle_[source]);
  return {half, static_cast<Index>(piece.origin), piece.from, direction};
}

void MergedPropagation::offer_targets_of(Half half, const FrontPiece& piece, const Rays& rays) {
  const double margin = window_margin * surface_.record(half).length;
  offer_targets(
      half, piece.from, piece.sigma,
      [&](const Place& at) {
        return crossing_to(rays.first, at) > piece.begin - margin && crossing_to(rays.last, at) < piece.end + margin;
      },
      [&](const Place& at) { return reached_by(half, piece, at); },
      [&](const Place& at) { return piece.error + missing_length(piece, at); });
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

/// Sets distances to the midpoints between the computed ones and their upper bounds; the true ones lie in between.
void MergedPropagation::finish() {
  for (std::size_t v = 0; v < distance_.size(); ++v) distance_[v] = 0.5 * (distance_[v] + upper_[v]);
  for (std::size_t k = 0; k < target_distance_.size(); ++k)
    target_distance_[k] = 0.5 * (target_distance_[k] + upper_[distance_.size() + k]);
  copy_vertex_targets();
}

std::size_t MergedPropagation::bytes() const {
  return Propagation::bytes() + waiting_.bytes() + turns_.bytes() + half_edges_to_clear_.bytes() +
         lists_.capacity() * sizeof(Lists) + pool_.capacity() * sizeof(FrontPiece) + upper_.capacity() * sizeof(double);
}

}  // namespace ahm::exact
