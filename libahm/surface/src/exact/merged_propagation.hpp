/// \file
/// Windows that wait for each other on the half-edges and are merged: distances within a tolerance, nearly linear in the
/// number of vertices.
///
/// Every shortest path is followed: where it crosses a half-edge, there is a piece whose distance is no longer than the
/// path so far, and every piece has distances that lack no more than its error. Both last, since
/// - of pieces that overlap, the lower is kept;
/// - a merged piece is lower than those it stands for, by what is added to the error;
/// - between the rays of two pieces that touch, the way goes through the point where they do: an origin there, or where
///   that adds little to the error, one of the two pieces, whose straight rays are shorter;
/// - what passes a vertex on either side may turn there: every vertex that is met is an origin. Where windows of other
///   origins reach, they are lower, and nothing is left of those of the vertex;
/// - pieces are dropped only where they lose to a distance of a vertex with all its error.
#pragma once

#include "bucket_queue.hpp"
#include "front_profile.hpp"
#include "propagation.hpp"

namespace ahm::exact {

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
