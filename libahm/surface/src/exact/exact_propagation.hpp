/// \file
/// Exact windows: the improved algorithm of Chen and Han [CH90, XW09].
#pragma once

#include "bucket_queue.hpp"
#include "propagation.hpp"

namespace ahm::exact {

class ExactPropagation final : public Propagation {
 public:
  ExactPropagation(const PolyhedralSurface& surface, const ExactOptions& options, std::span<const MeshPoint> targets);

  void run(const Progress& progress) override;

 private:
  std::size_t bytes() const override;

  /// A vertex whose shortest path may bend there.
  struct Bend {
    Index vertex;
    double distance;
  };
  /// The apex of a half-edge as the best of the windows that cross the half-edge sees it.
  struct Sighting {
    double distance;
    double crossing;
  };

  void start(const Window& w) override;
  void nearer(std::size_t row, double distance, double error) override;

  void bend(const Bend& event);
  void fill(Corner corner, double turned, double high, std::uint32_t origin2);

  inline bool loses(const Window& w, double at_begin, double at_end) const;
  void cross_face(const Window& w);
  inline void go_left(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  inline void go_right(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  inline void push(const Window& w, double sigma, double at_begin, double at_end);
  bool hides(const Window& w, bool right) const;
  void see_targets_of(const Window& w, double sigma);
  double farthest_target() override;

  std::vector<Sighting> sighting_;    ///< per half-edge
  std::vector<Place> sighting_from_;  ///< where that window comes from; empty: no matter
  BucketQueue<Window> windows_;
  BucketQueue<Bend> bends_;
};

}  // namespace ahm::exact
