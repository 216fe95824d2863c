/// \file
/// What the propagations of windows have in common: sources, targets, and what has been reached.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "ahm/surface/exact/exact_map.hpp"
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

/// What a propagation leaves.
struct Found {
  std::vector<double> distance, target_distance;  ///< infinite: not reached
  std::vector<Reached> reached;                   ///< vertices, then targets
  std::vector<Origin> origins;                    ///< sources first; directions by true angles
  double horizon;                                 ///< up to here distances are final
  ExactStatistics statistics;
};

/// How far beside a window a point still counts as covered, and how wide a window must be; relative to the side.
inline constexpr double window_margin = 1e-12, least_width = 1e-14;
/// A window is dropped where it loses to a known distance by more than this, relatively.
inline constexpr double slack = 1 + 1e-12;
/// Width of a bucket in mean side lengths.
inline constexpr double bucket_width = 0.25;

/// Whether an origin lies on the line of a side, in its frame. Rays that meet a side at a smaller angle, or from its other
/// side by rounding, run along it; its ends see them.
inline bool on_line(const Place& from, double length) { return !(-from[1] > 1e-15 * (std::abs(from[0]) + length)); }

/// One run from a set of sources. Sources first, then `run`, then what it found.
class Propagation {
 public:
  Propagation(const PolyhedralSurface& surface, const ExactOptions& options, std::span<const MeshPoint> targets);
  virtual ~Propagation() = default;
  Propagation(const Propagation&) = delete;
  Propagation& operator=(const Propagation&) = delete;

  void add_source(const MeshPoint& point);
  /// @throws Cancelled, InvalidGeometry (fault windows_without_end)
  virtual void run(const Progress& progress) = 0;

  /// Ends it.
  Found found() &&;

 protected:
  virtual std::size_t bytes() const;  ///< that are held

  /// What leaves an origin that lies in the face of a half-edge, in its frame; as in `Window`.
  struct Ray {
    Half half;
    Place from;
    double turn;
    std::uint32_t origin2;
  };
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// A window that starts at an origin.
  virtual void start(const Window& w) = 0;
  /// Vertex or, from the number of the vertices on, target `row` has become nearer.
  /// @param error  how far above that its true distance may be
  virtual void nearer(std::size_t row, double distance, double error) = 0;
  /// No target is farther.
  virtual double farthest_target() = 0;

  /// Takes both queues in the order of their buckets, what starts at vertices first, as far as the horizon or until
  /// nothing that waits can reach a target any earlier.
  template <class Vertices, class AtVertex, class Windows, class AtWindow>
  void drain(Vertices& vertices, const AtVertex& at_vertex, Windows& windows, const AtWindow& at_window,
             const Progress& progress);

  void light_corner(const Ray& ray, double low, double high);
  Ray in_next(const Ray& ray) const;
  static void mirror(Window& w, double length);

  Reached reach(const Ray& ray, const Place& at) const;
  /// Takes a shorter distance of a vertex; false: it is none.
  bool shorten(Index vertex, double distance) {
    if (!(distance < distance_[vertex])) return false;
    if (distance_[vertex] == infinity) ++met_;
    distance_[vertex] = distance;
    return true;
  }
  void offer(Index vertex, double distance, const Ray& ray, const Place& at) {
    if (!shorten(vertex, distance)) return;
    reached_[vertex] = reach(ray, at);
    nearer(static_cast<std::size_t>(vertex), distance, origin_error(ray.origin2 / 2));
  }
  bool has_targets() const { return !targets_of_face_.empty(); }
  /// Offers straight ways to the targets in the face of a half-edge.
  /// @param sigma    the distance of the origin `from`, which is in the frame of the half-edge, as is `at`
  /// @param covers   covers(at): whether rays get there
  /// @param reached  reached(at) of a target
  /// @param error    error(at) of its distance
  template <class Covers, class Reach, class Error>
  void see_targets(Half half, const Place& from, double sigma, const Covers& covers, const Reach& reached,
                   const Error& error);
  double origin_error(std::size_t origin) const {
    return origin < sources_ || origin_error_.empty() ? 0.0 : origin_error_[origin - sources_];
  }
  /// A target at a vertex is that vertex.
  void copy_vertex_targets();
  /// @throws InvalidGeometry where windows run in circles
  void check_count() const;
  double fraction() const { return met_ / static_cast<double>(distance_.size()); }

  const PolyhedralSurface& surface_;
  double horizon_;
  bool only_targets_;
  Offset most_windows_;  ///< 0: no limit
  std::size_t sources_ = 0;
  std::vector<double> distance_, target_distance_;
  std::vector<Reached> reached_;
  std::vector<Origin> origins_;
  std::vector<double> origin_error_;  ///< of those after the sources; empty: none
  std::vector<Index> target_vertex_;  ///< -1: none
  Offset made_ = 0;

 private:
  void place_targets(std::span<const MeshPoint> targets);
  void add_vertex_source(std::uint32_t origin2, Index vertex);
  void see_beyond_right(const Ray& ray);
  void light_right(const Ray& ray, double begin, double end);
  Window beyond_right(const Ray& ray, double begin, double end) const;
  void see_face(const Ray& ray);

  std::vector<Vec2> targets_;            ///< in the frame of side 0 of their faces
  std::vector<Index> target_order_;      ///< by face
  std::vector<Offset> targets_of_face_;  ///< faces + 1; empty: none
  Index met_ = 0;                        ///< vertices that were offered a distance
};

template <class Vertices, class AtVertex, class Windows, class AtWindow>
void Propagation::drain(Vertices& vertices, const AtVertex& at_vertex, Windows& windows, const AtWindow& at_window,
                        const Progress& progress) {
  Offset chunks = 0;
  while (!windows.empty() || !vertices.empty()) {
    progress.step("windows", fraction());
    if (windows.key() > horizon_) break;
    if (only_targets_) horizon_ = std::min(horizon_, farthest_target());
    if (windows.key() > horizon_) break;
    if (most_windows_ > 0 && made_ >= most_windows_) {
      horizon_ = windows.key();
      break;
    }
    while (!windows.bucket_empty() || !vertices.bucket_empty()) {
      while (!vertices.bucket_empty()) vertices.drain_chunk(at_vertex);
      if (windows.bucket_empty()) continue;
      windows.drain_chunk(at_window);
      check_count();
      if (++chunks % 65536 == 0) progress.step("windows", fraction());
    }
    windows.advance();
    vertices.advance();
  }
}

template <class Covers, class Reach, class Error>
void Propagation::see_targets(Half half, const Place& from, double sigma, const Covers& covers, const Reach& reached,
                              const Error& error) {
  const Index face = half / 3;
  const HalfRecord& side0 = surface_.record(3 * face);
  const HalfRecord& r = surface_.record(half);
  const int s = half % 3;
  for (Offset k = targets_of_face_[face]; k < targets_of_face_[face + 1]; ++k) {
    const Index target = target_order_[k];
    const Place& placed = targets_[target];
    const Place at = s == 0 ? placed : s == 1 ? exact::in_next(side0, placed) : in_previous(side0, placed);
    const double d = sigma + distance(from, at);
    if (!(d < target_distance_[target]) || !covers(at)) continue;
    target_distance_[target] = d;
    Reached& there = reached_[distance_.size() + target];
    there = reached(at);
    there.from = s == 0 ? from : s == 1 ? in_previous(r, from) : exact::in_next(r, from);
    there.half = 3 * face;
    nearer(distance_.size() + static_cast<std::size_t>(target), d, error(at));
  }
}

}  // namespace ahm::exact
