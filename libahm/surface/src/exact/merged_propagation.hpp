/// \file
/// Propagation with a tolerance: the lowest distances along each half-edge, in which adjacent windows are merged.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"
#include "exact/propagation.hpp"

namespace ahm::exact {

/// Rays that enter a face together, from an origin that may be virtual. Distances are never longer than the true ones, and
/// shorter by less than `error`.
struct FrontPiece {
  double begin, end;  ///< interval of the half-edge that the rays cross, from its tail
  Place from;         ///< origin in the frame of the half-edge; y < 0
  double sigma;       ///< distance of the origin
  double error;       ///< maximum amount by which distances are too short
  double turn, gain;  ///< the direction of a ray at the source is turn + gain * (its angle in this frame)
  std::uint32_t origin;
  std::uint32_t next;  ///< next piece of a list in the pool

  double at(double t) const { return sigma + exact::distance(from, {t, 0}); }
  /// Derivative of the distance along the half-edge.
  double slope(double t) const { return (t - from[0]) / exact::distance(from, {t, 0}); }
  double lowest() const;
  double direction(double t) const { return gain == 0 ? turn : turn + gain * std::atan2(-from[1], t - from[0]); }
};

/// How much longer the path through position t of the half-edge to p is than the straight line from the origin to p.
inline double detour(const Place& from, double t, const Place& p) {
  return exact::distance(from, {t, 0}) + distance({t, 0}, p) - distance(from, p);
}

/// Conditions for merging pieces.
struct MergeRules {
  double tolerance;                    ///< maximum error, relative to distances
  std::span<const Origin> origins;     ///< only pieces of one source are merged
  std::span<const double> full_angle;  ///< angle around each source; infinite on the boundary
};

/// Adjacent pieces on a half-edge. Reusable: it keeps its memory.
class FrontProfile {
 public:
  struct Entry {
    FrontPiece piece;
    bool fresh;  ///< whether it has not yet crossed the face
  };

  void clear(double length) { entries_.clear(), length_ = length; }
  /// Adds a piece that has crossed the face. Calls are in order from left to right.
  void add_passed(const FrontPiece& piece) { entries_.push_back({piece, false}); }
  /// Inserts a fresh piece where it is lower than the pieces there.
  void insert(const FrontPiece& piece);
  template <class Test>
  void drop_fresh_if(const Test& test) {
    std::erase_if(entries_, [&](const Entry& e) { return e.fresh && test(e.piece); });
  }
  /// Replaces adjacent fresh pieces by one piece where the error allows it. The new piece has their distances at both ends, is
  /// no higher in between, and its rays at the ends open at least as wide [SSKGH05].
  void merge(const MergeRules& rules);
  /// Closes gaps between pieces that are only rounding.
  void close_gaps();

  std::span<const Entry> entries() const { return entries_; }

 private:
  void emit(const Entry& entry, double begin, double end);
  void contest(const Entry& challenger, const Entry& holder, double begin, double end);
  double crossing(const FrontPiece& a, const FrontPiece& b, double low, double high) const;

  std::vector<Entry> entries_, out_;
  double length_ = 0;
};

/// The maximum of a - b between two points of the half-edge.
double highest_difference(const FrontPiece& a, const FrontPiece& b, double begin, double end);

/// Merges several adjacent pieces into one; none where the error would be too large.
std::optional<FrontPiece> merged(std::span<const FrontProfile::Entry> run, const MergeRules& rules);

class MergedPropagation final : public Propagation {
 public:
  /// @param options  with a tolerance > 0
  MergedPropagation(const PolyhedralSurface& surface, const ExactOptions& options, std::span<const MeshPoint> targets);

  void run(const Progress& progress) override;

 private:
  std::size_t bytes() const override;

  /// A vertex that becomes an origin.
  struct Turn {
    Index vertex;
    double distance;
  };
  /// A half-edge with waiting pieces.
  struct Side {
    Half half;
    double key;
  };
  /// Pieces of one half-edge, as lists in the pool, and the key at which they cross its face. Passed pieces have crossed the
  /// face, and are in order from left to right. Waiting pieces are in any order.
  struct Lists {
    std::uint32_t passed, waiting;
    double key;
  };
  /// Rays at both ends of a piece that crosses a face: those of its own origin, or wider ones.
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
  void discard_passed();
  void leave(Half half);
  void cross_face(Half half, std::size_t entry);
  bool extends(const FrontPiece& piece, double t, const Place& ray, double reach) const;
  void continue_piece(Half half, const FrontPiece& piece, const Rays& rays);
  void continue_left(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex);
  void continue_right(Half half, const FrontPiece& piece, const Rays& rays, bool to_apex);
  void offer_apex(Half half, const FrontPiece& piece);
  void offer_targets_of(Half half, const FrontPiece& piece, const Rays& rays);
  ArrivalRecord reached_by(Half half, const FrontPiece& piece, const Place& at) const;
  double farthest_target() override;
  void set_full_angles();
  void finish();

  std::uint32_t take(const FrontPiece& piece);
  void give_back(std::uint32_t piece);

  double tolerance_;           ///< relative, of the errors: twice that of the distances, which are midpoints
  std::vector<double> upper_;  ///< upper bound on the distance of each vertex and target
  std::vector<Lists> lists_;   ///< lists of each half-edge
  std::vector<FrontPiece> pool_;
  std::uint32_t free_;
  std::vector<double> full_angle_;  ///< angle around each source; infinite on the boundary
  BucketQueue<Side> waiting_;
  BucketQueue<Turn> turns_;
  BucketQueue<Half>
      half_edges_to_clear_;  ///< half-edges with passed pieces, by the key from which these may be useless
  FrontProfile profile_;
};

}  // namespace ahm::exact
