#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "front_profile.hpp"

namespace ahm::exact {
namespace {

/// As many pieces as become one at a time.
constexpr std::size_t most_at_once = 12;
/// Pieces whose directions at the source jump by more are kept apart.
constexpr double most_turn = 0.05;
/// How far the origin of a merged piece may be, in distances and widths of the piece.
constexpr double farthest_origin = 1e4;
/// Gaps of pieces that touch but for rounding, relative to the side.
constexpr double closed_gap = 1e-9;

using Run = std::span<const FrontProfile::Entry>;

/// A piece over [begin, end] with given distances at both ends, and `near` as far as its origin is from the first.
struct Ends {
  double begin, width, at_begin, rise;

  /// The same for an origin whose distances pass through a third point, or less.
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

/// The origin whose distances agree at both ends of a run and are no higher between them.
std::optional<FrontPiece> below(Run run) {
  const FrontPiece &first = run.front().piece, &last = run.back().piece;
  const double at_begin = first.at(first.begin), at_end = last.at(last.end);
  const Ends ends{first.begin, last.end - first.begin, at_begin, at_end - at_begin};
  if (!(std::abs(ends.rise) < ends.width)) return {};
  double near = farthest_origin * (at_begin + at_end + ends.width);
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

/// Directions as those of the run at both ends, in between by the angle of the ray; false where those of the run jump.
bool turn_as(Run run, double full_angle, FrontPiece& piece) {
  const double start = run.front().piece.direction(run.front().piece.begin);
  double end = start;
  for (const auto& [old, fresh] : run) {
    double jump = old.direction(old.begin) - end;
    if (std::isfinite(full_angle)) jump -= full_angle * std::round(jump / full_angle);
    if (std::abs(jump) > most_turn) return false;
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
  if (!turn_as(run, rules.full_angle[source], *piece)) return {};
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
    while (best.fresh && end < entries_.size() && entries_[end].fresh && end - k < most_at_once &&
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

}  // namespace ahm::exact
