/// \file
/// The distance along one half-edge, as the windows that cross it have it: the lowest of them, and fewer in their place.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"
#include "exact/propagation.hpp"

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

class MergedPropagation final : public Propagation {
 public:
  /// @param options  with a tolerance > 0
  MergedPropagation(const PolyhedralSurface& surface, const ExactOptions& options, std::span<const MeshPoint> targets);

  void run(const Progress& progress) override;

 private:
  std::size_t bytes() const override;

  /// A vertex that is an origin.
  struct Turn {
    Index vertex;
    double distance;
  };
  /// A half-edge on which pieces wait.
  struct Side {
    Half half;
    double key;
  };
  /// Pieces of one half-edge, in the pool: those that have crossed its face from left to right, those that wait in any
  /// order; and when they will cross.
  struct Lists {
    std::uint32_t passed, waiting;
    double key;
  };
  /// The rays at both ends of what crosses a face: those of its own origin, or wider ones.
  struct Rays {
    Place first, last;
  };

  void start(const Window& w) override;
  void nearer(std::size_t row, double distance, double error) override;
  void turn(const Turn& event);

  void wait(Half half, const FrontPiece& piece);
  bool loses(const HalfRecord& r, const FrontPiece& piece) const;
  void cross_side(const Side& event);
  void gather(const Side& event);
  void keep(Half half);
  void forget_passed();
  void leave(Half half);
  void cross_face(Half half, std::size_t entry);
  bool extends(const FrontPiece& piece, double t, const Place& ray, double reach) const;
  void go_on(Half half, const FrontPiece& piece, const Rays& rays);
  void go_left(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex);
  void go_right(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex);
  void see_apex(Half half, const FrontPiece& piece);
  void see_targets_of(Half half, const FrontPiece& piece, const Rays& rays);
  Reached reached_by(Half half, const FrontPiece& piece, const Place& at) const;
  double farthest_target() override;
  void set_full_angles();
  void finish();

  std::uint32_t take(const FrontPiece& piece);
  void give_back(std::uint32_t piece);

  double tolerance_;           ///< of the errors: twice that of the distances, which are taken from the middle
  std::vector<double> upper_;  ///< no vertex or target is farther
  std::vector<Lists> lists_;   ///< per half-edge
  std::vector<FrontPiece> pool_;
  std::uint32_t free_;
  std::vector<double> full_angle_;  ///< about each source; infinite at the boundary
  BucketQueue<Side> waiting_;
  BucketQueue<Turn> turns_;
  BucketQueue<Half> leaving_;  ///< those with pieces that have passed, by when they may be of no use any more
  FrontProfile profile_;
};

}  // namespace ahm::exact
