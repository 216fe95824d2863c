#include "front_profile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ahm::exact {
namespace {

/// Relative to the side: pieces narrower than this go to their neighbour; where two are equal is found to that.
constexpr double least_piece = 1e-11, crossing_width = 1e-10;
/// Of distances, relatively.
constexpr double rounding = 1e-14;
/// Every third one halves the interval, which ends it in time where distances bend sharply.
constexpr int crossing_steps = 120;

/// Where the rays of two pieces are parallel, the difference of their distances is extremal; NaN or infinite: nowhere.
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
    if (same || end - begin < least_piece * length_) {
      last.end = end;
      return;
    }
  }
  out_.push_back(entry);
  out_.back().piece.begin = begin;
  out_.back().piece.end = end;
}

/// Where two pieces are equal, one of them being lower at one end and the other at the other: regula falsi (Illinois).
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

/// Emits the lower of two where both are; where they are equal, the holder.
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

}  // namespace ahm::exact
