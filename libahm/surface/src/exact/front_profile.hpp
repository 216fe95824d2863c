/// \file
/// The distance along one half-edge, as the windows that cross it have it: the lowest of them, and fewer in their place.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"
#include "unfold.hpp"

namespace ahm::exact {

/// Rays that enter a face together, from an origin that need not be one: distances are no longer than the true ones, and
/// less than `error` shorter.
struct FrontPiece {
  double begin, end;  ///< where they cross the half-edge, from its tail
  Place from;         ///< in the frame of the half-edge; y < 0
  double sigma;       ///< distance of `from`
  double error;       ///< what distances may lack
  double turn, gain;  ///< the direction at the source is turn + gain * the angle of the ray in this frame
  std::uint32_t origin;
  std::uint32_t next;  ///< of a list in a pool

  double at(double t) const { return sigma + exact::distance(from, {t, 0}); }
  /// Of the distance, along the half-edge.
  double slope(double t) const { return (t - from[0]) / exact::distance(from, {t, 0}); }
  double lowest() const;
  double direction(double t) const { return gain == 0 ? turn : turn + gain * std::atan2(-from[1], t - from[0]); }
};

/// How much longer the way through a point of the half-edge to p, beyond it, is than the straight one from an origin.
inline double detour(const Place& from, double t, const Place& p) {
  return exact::distance(from, {t, 0}) + distance({t, 0}, p) - distance(from, p);
}

/// When pieces may become one.
struct MergeRules {
  double tolerance;                    ///< of the error, relative to distances
  std::span<const Origin> origins;     ///< only pieces of one source
  std::span<const double> full_angle;  ///< about each source; infinite at the boundary
};

/// Pieces side by side on a half-edge. For use again and again: it keeps its memory.
class FrontProfile {
 public:
  struct Entry {
    FrontPiece piece;
    bool fresh;  ///< else it has crossed the face already
  };

  void clear(double length) { entries_.clear(), length_ = length; }
  /// From left to right.
  void add_passed(const FrontPiece& piece) { entries_.push_back({piece, false}); }
  /// A fresh piece, where it is lower than what is there.
  void insert(const FrontPiece& piece);
  template <class Test>
  void drop_fresh_if(const Test& test) {
    std::erase_if(entries_, [&](const Entry& e) { return e.fresh && test(e.piece); });
  }
  /// Puts one piece in the place of fresh neighbours where the error allows it. It has their distances at both ends, is no
  /// higher between them, and its rays there open at least as wide [SSKGH05].
  void merge(const MergeRules& rules);
  /// Rays that are one but for rounding end and begin at one point.
  void close_gaps();

  std::span<const Entry> entries() const { return entries_; }

 private:
  void emit(const Entry& entry, double begin, double end);
  void contest(const Entry& challenger, const Entry& holder, double begin, double end);
  double crossing(const FrontPiece& a, const FrontPiece& b, double low, double high) const;

  std::vector<Entry> entries_, out_;
  double length_ = 0;
};

/// The largest a - b between two points of the half-edge.
double highest_difference(const FrontPiece& a, const FrontPiece& b, double begin, double end);

/// One piece for several that touch; none where the error would be too large.
std::optional<FrontPiece> merged(std::span<const FrontProfile::Entry> run, const MergeRules& rules);

}  // namespace ahm::exact
