/// \file
/// Windows on their way over the surface: the improved algorithm of Chen and Han [CH90, XW09].
#pragma once

#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"
#include "bucket_queue.hpp"
#include "unfold.hpp"

namespace ahm::exact {

/// Straight rays from one origin that enter a face together.
struct Window {
  double begin, end;      ///< where they cross the half-edge, from its tail
  Place from;             ///< the origin in the frame of the half-edge; y < 0
  double turn;            ///< the direction of a ray at the source is turn + its angle in this frame, or turn - it
  Half half;              ///< of the face they enter
  std::uint32_t origin2;  ///< twice the origin, plus 1 where the frame is a mirror image of the source's

  std::size_t origin() const { return origin2 >> 1; }
  bool mirrored() const { return (origin2 & 1) != 0; }
};

/// What is known of a vertex or target besides its distance.
struct Reached {
  Half half = -1;  ///< as `Arrival`
  Index origin = -1;
  Place from{};
  double direction = 0;  ///< by true angles
};

/// One run from a set of sources. Sources first, then `run`, then the results.
class Propagation {
 public:
  Propagation(const PolyhedralSurface& surface, double radius, std::span<const MeshPoint> targets, bool only_targets);

  void add_source(const MeshPoint& point);
  /// @throws Cancelled
  void run(const Progress& progress = {});

  std::span<const double> distances() const { return distance_; }  ///< of the vertices; infinite: not reached
  std::span<const double> target_distances() const { return target_distance_; }
  std::span<const Reached> reached() const { return reached_; }  ///< vertices, then targets
  std::span<const Origin> origins() const { return origins_; }   ///< sources first; directions by true angles
  double horizon() const { return horizon_; }                    ///< up to here distances are final
  Offset windows() const { return made_; }
  std::size_t bytes() const;

 private:
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
  /// What leaves an origin that lies in the face of a half-edge, in its frame; as in `Window`.
  struct Ray {
    Half half;
    Place from;
    double turn;
    std::uint32_t origin2;
  };

  void place_targets(std::span<const MeshPoint> targets);

  void add_vertex_source(std::uint32_t origin2, Index vertex);
  Ray in_next(const Ray& ray) const;
  void see_beyond_right(const Ray& ray);
  void light_right(const Ray& ray, double begin, double end);
  void light_corner(const Ray& ray, double low, double high);
  Window beyond_right(const Ray& ray, double begin, double end) const;
  static void mirror(Window& w, double length);

  void bend(const Bend& event);
  void fill(Corner corner, double turned, double high, std::uint32_t origin2);

  void cross_face(const Window& w);
  void go_left(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  void go_right(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  void push(const Window& w, double sigma, double at_begin, double at_end);

  Reached reach(const Ray& ray, const Place& at) const;
  void offer(Index vertex, double distance, const Ray& ray, const Place& at);
  void see_face(const Ray& ray);
  void see_targets(const Window& w, double sigma);
  void copy_vertex_targets();
  bool targets_final();

  const PolyhedralSurface& surface_;
  double horizon_;
  bool only_targets_;
  std::size_t sources_ = 0;
  std::vector<double> distance_, target_distance_;
  std::vector<Reached> reached_;
  std::vector<Sighting> sighting_;  ///< per half-edge
  std::vector<Origin> origins_;
  std::vector<Vec2> targets_;            ///< in the frame of side 0 of their faces
  std::vector<Index> target_vertex_;     ///< -1: none
  std::vector<Index> target_order_;      ///< by face
  std::vector<Offset> targets_of_face_;  ///< faces + 1; empty: none
  BucketQueue<Window> windows_;
  BucketQueue<Bend> bends_;
  Offset made_ = 0;
  Index met_ = 0;  ///< vertices that were offered a distance
};

}  // namespace ahm::exact
