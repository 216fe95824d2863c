/// \file
/// Propagation of windows over a polyhedral surface, and the frames and queues that it uses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/surface/exact/exact_map.hpp"
#include "ahm/surface/exact/polyhedral_surface.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::exact {

/// Checks a point. Returns it with weights that sum to 1; weights below 1e-14 become zero.
/// @throws InvalidArgument
inline MeshPoint checked(const PolyhedralSurface& surface, MeshPoint point, const std::string& name) {
  auto& b = point.barycentric;
  if (point.face < 0 || point.face >= surface.face_count())
    throw InvalidArgument(name + ": face " + std::to_string(point.face) + " is outside [0, " +
                          std::to_string(surface.face_count()) + ")");
  if (!(std::abs(b[0] + b[1] + b[2] - 1) <= 1e-9) || !(std::min({b[0], b[1], b[2]}) >= -1e-9))
    throw InvalidArgument(name + ": barycentric coordinates (" + detail::number(b[0]) + ", " + detail::number(b[1]) +
                          ", " + detail::number(b[2]) + ") in face " + std::to_string(point.face) +
                          " must be >= 0 and sum to 1");
  for (double& w : b) w = w < 1e-14 ? 0.0 : w;
  const double sum = b[0] + b[1] + b[2];
  for (double& w : b) w /= sum;
  return point;
}

/// The vertex of a checked point with two zero weights; -1 otherwise.
inline Index vertex_of(const PolyhedralSurface& surface, const MeshPoint& point) {
  Index vertex = -1;
  for (int s = 0; s < 3; ++s) {
    if (!(point.barycentric[s] > 0)) continue;
    if (vertex >= 0) return -1;
    vertex = surface.record(3 * point.face + s).tail;
    if (point.barycentric[s] < 1) return -1;
  }
  return vertex;
}

/// A queue of items by ascending key, in any order within a bucket [XWLLH15]. Items whose keys are beyond the ring of buckets
/// are stored in its last bucket. They come out too early, which costs only time. Memory grows by chunks and is reused.
template <class Item>
class BucketQueue {
 public:
  static constexpr std::uint32_t per_chunk = 42, ring = 4096, none = ~0u;
  struct Chunk {
    std::uint32_t count = 0, next = none;
    Item items[per_chunk];
  };

  BucketQueue() : first_(ring, none) {}

  /// Removes all items and begins at the first bucket, with buckets of this width. Keeps the memory. Call it before `push`.
  void clear(double width) {
    for (std::uint32_t& head : first_) {
      if (size_ == 0) break;
      while (head != none) {
        const std::uint32_t taken = head;
        head = chunks_[taken]->next;
        size_ -= chunks_[taken]->count;
        chunks_[taken]->next = free_;
        free_ = taken;
      }
    }
    inverse_width_ = 1 / width;
    bucket_ = 0;
  }

  void push(double key, const Item& item) {
    std::uint32_t& head = first_[slot(key)];
    if (head == none || chunks_[head]->count == per_chunk) {
      const std::uint32_t fresh = take();
      chunks_[fresh]->next = head;
      head = fresh;
    }
    Chunk& chunk = *chunks_[head];
    chunk.items[chunk.count++] = item;
    ++size_;
  }

  bool empty() const { return size_ == 0; }
  /// Lower end of the current bucket.
  double key() const { return static_cast<double>(bucket_) / inverse_width_; }
  bool bucket_empty() const { return first_[bucket_ % ring] == none; }
  /// Moves to the next bucket.
  void advance() { ++bucket_; }

  /// Removes the top chunk of the current bucket and calls visit(item) for each of its items. `visit` may push items.
  template <class Visit>
  void drain_chunk(const Visit& visit) {
    std::uint32_t& head = first_[bucket_ % ring];
    const std::uint32_t taken = head;
    head = chunks_[taken]->next;
    size_ -= chunks_[taken]->count;
    const Chunk& chunk = *chunks_[taken];
    for (std::uint32_t k = 0; k < chunk.count; ++k) visit(chunk.items[k]);
    chunks_[taken]->next = free_;
    free_ = taken;
  }

  std::size_t bytes() const { return chunks_.size() * sizeof(Chunk) + first_.size() * sizeof(std::uint32_t); }

 private:
  std::size_t slot(double key) const {
    const double position = key * inverse_width_;
    const auto last = bucket_ + ring - 1;
    const auto bucket = position < static_cast<double>(last) ? static_cast<std::uint64_t>(position) : last;
    return std::max(bucket, bucket_) % ring;
  }
  std::uint32_t take() {
    if (free_ == none) {
      chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
      return static_cast<std::uint32_t>(chunks_.size() - 1);
    }
    const std::uint32_t taken = free_;
    free_ = chunks_[taken]->next;
    chunks_[taken]->count = 0;
    return taken;
  }

  double inverse_width_ = 1;
  std::uint64_t bucket_ = 0;
  std::vector<std::uint32_t> first_;  ///< top chunk of each bucket in the ring
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::uint32_t free_ = none;
  std::uint64_t size_ = 0;
};

/// A point or an origin in the frame of a half-edge.
using Place = Vec2;

[[gnu::always_inline]] inline double distance(const Place& a, const Place& b) { return norm(a - b); }
/// The angle between two vectors, in [0, pi].
inline double angle_between(const Vec2& a, const Vec2& b) { return std::abs(std::atan2(cross(a, b), dot(a, b))); }
inline Place apex(const HalfRecord& r) { return {r.apex_x, r.apex_y}; }

/// Converts a place to the frame of the half-edge across the left side, which runs from the tail to the apex (glued without
/// mirroring).
inline Place beyond_left(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.left;
  return {(p[0] * r.apex_x + p[1] * r.apex_y) * scale, (p[1] * r.apex_x - p[0] * r.apex_y) * scale};
}

/// Converts a place to the frame of the half-edge across the right side, which runs from the apex to the head (glued without
/// mirroring).
inline Place beyond_right(const HalfRecord& r, const Place& p) {
  const double scale = 1 / r.right, c = r.back_x * scale, s = r.apex_y * scale, x = p[0] - r.length;
  return {r.right + x * c - p[1] * s, x * s + p[1] * c};
}

/// Converts a place to the frame of the next half-edge of the same face.
inline Place in_next(const HalfRecord& r, const Place& p) {
  const Place q = beyond_right(r, p);
  return {r.right - q[0], -q[1]};
}

/// Converts a place to the frame of the previous half-edge of the same face.
inline Place in_previous(const HalfRecord& r, const Place& p) {
  const Place q = beyond_left(r, p);
  return {r.left - q[0], -q[1]};
}

/// Where the ray from an origin below a half-edge to a point above it crosses the line of the half-edge.
inline double crossing_to(const Place& from, const Place& at) {
  return from[0] - (at[0] - from[0]) * from[1] / (at[1] - from[1]);
}

/// Where the ray from an origin below a half-edge through position t on it crosses the line of the left or right side. Positions
/// on the left side are measured from the tail, on the right side from the apex.
inline double hit_left(const HalfRecord& r, const Place& from, double t) {
  const double down = -from[1];
  return t * down / (down * r.apex_x + (from[0] - t) * r.apex_y) * r.left;
}
inline double hit_right(const HalfRecord& r, const Place& from, double t) {
  const double down = -from[1], u = r.length - t;
  return r.right - u * down / (down * r.back_x + (r.length - from[0] - u) * r.apex_y) * r.right;
}

/// The point at position t of the left side, and of the right side.
inline Place on_left(const HalfRecord& r, double t) {
  const double part = t / r.left;
  return {part * r.apex_x, part * r.apex_y};
}
inline Place on_right(const HalfRecord& r, double t) {
  const double part = (r.right - t) / r.right;
  return {r.length - part * r.back_x, part * r.apex_y};
}

/// A window: straight rays from one origin that enter a face together.
struct Window {
  double begin, end;      ///< interval of the half-edge that the rays cross, from its tail
  Place from;             ///< origin in the frame of the half-edge; y < 0
  double turn;            ///< direction of a ray at the source: turn + its angle in this frame; minus if mirrored
  Half half;              ///< half-edge of the face that the rays enter
  std::uint32_t origin2;  ///< twice the origin's number, plus 1 where the frame is a mirror image of the source's

  std::size_t origin() const { return origin2 >> 1; }
  bool mirrored() const { return (origin2 & 1) != 0; }
};

/// Properties of a reached vertex or target, except its distance.
struct ArrivalRecord {
  Half half = -1;  ///< as in `Arrival`
  Index origin = -1;
  Place from{};
  double direction = 0;   ///< direction at the source, as an unscaled angle
  bool mirrored = false;  ///< whether the frame of the half-edge is a mirror image of the source's
};

/// Results of a propagation.
struct PropagationResult {
  std::vector<double> distance, target_distance;  ///< infinite: not reached
  std::vector<ArrivalRecord> reached;             ///< vertices, then targets
  std::vector<Origin> origins;                    ///< sources first; directions are unscaled angles
  double horizon;                                 ///< distances up to this are final
  ExactStatistics statistics;
};

/// Propagation from a set of sources. Call `add_sources` once, then `run`, then `check_reached` and `found`. After `clear`
/// the same memory serves another set of sources.
class Propagation {
 public:
  Propagation(const PolyhedralSurface& surface, const ExactOptions& options, std::span<const MeshPoint> targets);

  void add_sources(std::span<const MeshPoint> points);
  /// @throws Cancelled, InvalidGeometry (fault windows_without_end)
  void run(const Progress& progress);
  /// Checks that no vertex is farther than a neighbor plus the side between them. Otherwise windows were lost, which happens in
  /// needles with angles near the rounding error. @throws InvalidGeometry (fault windows_lost)
  void check_reached() const;

  /// Distances up to this are final: those of `touched` within it are the results.
  double horizon() const { return horizon_; }
  /// The vertices with a distance, in the order in which they were reached.
  std::span<const Index> touched() const { return touched_; }
  double distance_of(Index vertex) const { return distance_[vertex]; }
  const ArrivalRecord& arrival_of(Index vertex) const { return reached_[vertex]; }
  const Origin& origin(Index number) const { return origins_[number]; }

  /// Returns the results and ends the propagation.
  PropagationResult found() &&;
  /// Removes the sources and results. The time depends on the number of vertices reached. Without targets only.
  /// @param options  radius, max_windows and max_vertices are used
  void clear(const ExactOptions& options);

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Rays that leave an origin in the face of a half-edge, in the frame of the half-edge. Members are as in `Window`.
  struct Ray {
    Half half;
    Place from;
    double turn;
    std::uint32_t origin2;
  };
  /// A vertex at which shortest paths may bend.
  struct Bend {
    Index vertex;
    double distance;
  };
  /// The apex of a half-edge, as reached by the best of the windows that cross the half-edge.
  struct ApexArrival {
    double distance;
    double crossing;
  };

  void place_targets(std::span<const MeshPoint> targets);

  void add_source(const MeshPoint& point);
  void add_vertex_source(std::uint32_t origin2, Index vertex);
  Ray in_next(const Ray& ray) const;
  void light_face_beyond_right(const Ray& ray);
  void light_right(const Ray& ray, double begin, double end);
  Window beyond_right(const Ray& ray, double begin, double end) const;
  static void mirror(Window& w, double length);
  void light_corner(const Ray& ray, double low, double high);

  ArrivalRecord reach(const Ray& ray, const Place& at) const;
  void offer(Index vertex, double distance, const Ray& ray, const Place& at);
  bool has_targets() const { return !targets_of_face_.empty(); }
  /// Offers straight paths to the targets in the face of a ray's half-edge.
  /// @param covers  covers(at): whether rays reach the place `at`, in the frame of the half-edge
  template <class Covers>
  void offer_targets(const Ray& ray, const Covers& covers);
  void offer_targets_in_face(const Ray& ray);
  void offer_targets_of(const Window& w);
  /// Copies the results of vertices to the targets at these vertices.
  void copy_vertex_targets();
  /// The distance of the farthest target so far.
  double farthest_target();

  void bend(const Bend& event);
  void fill(Corner corner, double turned, double high, std::uint32_t origin2);

  inline bool loses(const Window& w, const HalfRecord& r, double at_begin, double at_end) const;
  void cross_face(const Window& w);
  inline void continue_left(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  inline void continue_right(const Window& w, const HalfRecord& r, double sigma, double to_apex);
  inline void push(const Window& w, double sigma, double at_begin, double at_end);
  bool hides(const Window& w, bool right) const;

  /// Checks the number of windows.
  /// @throws InvalidGeometry where windows run in circles
  void check_count() const;
  /// Whether `max_vertices_` vertices have their final distance when all paths up to this distance are known.
  bool has_enough_within(double distance) const;
  double fraction() const { return static_cast<double>(touched_.size()) / static_cast<double>(distance_.size()); }
  template <class Visit>
  void for_each_corner(Index vertex, const Visit& visit) const;
  std::size_t bytes() const;  ///< memory in use

  const PolyhedralSurface& surface_;
  double horizon_;
  bool only_targets_;
  Offset max_windows_;  ///< maximum number of windows; 0: no limit
  Index max_vertices_;  ///< ends when so many vertices are within the completed distance; 0: never
  std::size_t sources_ = 0;
  std::vector<double> distance_, target_distance_;
  std::vector<ArrivalRecord> reached_;
  std::vector<Origin> origins_;
  std::vector<Vec2> targets_;            ///< positions of the targets in the frame of side 0 of their faces
  std::vector<Index> target_vertex_;     ///< vertex of each target; -1: none
  std::vector<Index> target_order_;      ///< numbers of the targets, sorted by face
  std::vector<Offset> targets_of_face_;  ///< first entry of each face in `target_order_`, faces + 1; empty: no targets
  std::vector<Index> touched_;           ///< vertices with a distance
  Offset window_count_ = 0;
  std::vector<ApexArrival> apex_arrivals_;   ///< best window of each half-edge
  std::vector<Half> crossed_;                ///< half-edges with such a window
  std::vector<Place> apex_arrival_origins_;  ///< origin of that window; empty: not needed
  BucketQueue<Window> windows_;
  BucketQueue<Bend> bends_;
};

}  // namespace ahm::exact
