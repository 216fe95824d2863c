/// \file
/// The state of a front.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <span>
#include <vector>

#include "ahm/maps/wavefront.hpp"
#include "maps/one_rings.hpp"

namespace ahm {

struct Wavefront::Impl {
  static constexpr Index none = -1;
  /// Largest number of improvements of an entry. Without it, inconsistent triangles could cause an infinite loop.
  static constexpr std::uint8_t most_gains = 40;

  using Corner = OneRings::Corner;
  using Neighbor = OneRings::Neighbor;
  /// Distance of a vertex from one point. Vertices near the border between two points have entries for both, so that both fronts can unfold
  /// across it. The entries of a vertex are contiguous, the nearest first, in blocks of 1, 2, 4, 8 or 16.
  struct Entry {
    double distance = 0, focusing = 0;  ///< distance, and m of docs/concepts/accuracy.md
    Index point = -1;
    std::uint8_t gains = 0;  ///< how often the distance was improved
    std::uint8_t count = 0;  ///< number of entries of the vertex; valid in the first of them
  };
  /// The geodesic path of an entry.
  struct Path {
    Vec2 direction;  ///< direction at the point, in the frame of the source
    Vec2 arrival{};  ///< direction at the vertex, in its frame; {0, 0}: from `last`; NaN: unknown
    /// Ends of the side that the path crosses last. Equal: it follows an edge. One of them -1: it is an edge from the source.
    std::array<Index, 2> last{-1, -1};
    float share = 0;        ///< where the path crosses that side: 0 at the first end, 1 at the second
    float variance = 0;     ///< sum of squared differences of the direction estimates (`direction_error`)
    float widening = 0;     ///< ln(J / d): `widening_between`
    bool mirrored = false;  ///< as `is_mirrored`

    /// Whether the path may turn at the start of its last edge. At the source it does not.
    bool follows_edge() const { return last[0] == last[1] && last[0] >= 0; }
  };
  /// A one-ring in the cache.
  struct CachedRing {
    Index vertex = -1;
    std::vector<Corner> corners;
  };
  /// State of a neighbor while the front spreads from a vertex.
  struct NeighborState {
    double distance, along, focusing;  ///< shortest distance so far, distance along the edge, m
    bool is_new;                       ///< whether this vertex has improved the distance
    Path path;
  };
  /// A neighbor from which the front comes along an axis (`eikonal_factor`).
  struct Upwind {
    double length, cosine, factor;
  };
  struct QueueEntry {
    double distance;
    Index vertex, point;
    bool operator>(const QueueEntry& other) const {
      return distance != other.distance ? distance > other.distance
                                        : (vertex != other.vertex ? vertex > other.vertex : point > other.point);
    }
  };
  /// A vertex near a point, with its position relative to the point from the source.
  struct NearVertex {
    Index vertex, point;
    double distance;
    Vec2 offset, arrival;  ///< position in the frame of the source; direction at the vertex, in its frame
    bool mirrored;
  };

  Impl(const TangentGraph& graph, std::shared_ptr<const OneRings> one_rings, bool directions);
  Index add(const Source& source);
  void clear();
  void forget();
  void restart(std::span<const Seed> seeds, std::function<bool(Vertex)> is_closed);
  void run(double radius, const StopToken& stop);
  std::vector<Vertex> reached() const;
  double next() const {
    return queue_.empty() ? std::numeric_limits<double>::infinity()
                          : (queue_.top().distance - longest_) * graph_.length_unit();
  }
  /// The nearest entry of a vertex; null if the front has not reached it.
  const Entry* nearest(Vertex vertex) const {
    const Index first = first_[vertex.index];
    return first < 0 ? nullptr : &entries_[first];
  }
  /// The path of the nearest entry; null without directions, too.
  const Path* path(Vertex vertex) const {
    const Index first = first_[vertex.index];
    return first < 0 || !directions_ ? nullptr : &paths_[first];
  }

  std::span<const Entry> entries_of(Index vertex) const {
    const Index first = first_[vertex];
    return first < 0 ? std::span<const Entry>() : std::span(&entries_[first], entries_[first].count);
  }
  const Entry* find(Index vertex, Index point) const {
    for (const Entry& entry : entries_of(vertex))
      if (entry.point == point) return &entry;
    return nullptr;
  }
  Index number(const Entry& entry) const { return static_cast<Index>(&entry - entries_.data()); }
  Index append(Index vertex);
  Index new_row(std::size_t size);
  void swap_entries(Index a, Index b);
  void offer_midpoints(std::vector<NearVertex>& given);
  void offer(Index vertex, Index point, double distance, double slack, std::span<const double> displacement,
             const Path& path, double focusing = 0);
  Index entry_to_replace(Index vertex, Index point, double distance);
  void spread(Index from, Index point, double distance);
  void carry(Index from, Index point, double distance);
  double factor_at(Index vertex, Index point, std::span<const double> displacement, double distance);
  std::span<const double> displacement(const Entry& entry) const {
    return std::span(displacements_).subspan(number(entry) * d_, d_);
  }
  std::span<const Corner> one_ring(Index vertex);
  double curvature(Index vertex);

  const TangentGraph& graph_;
  std::size_t d_;
  std::vector<Index> first_;    ///< first entry of each vertex or midpoint; -1: none
  std::vector<Index> touched_;  ///< vertices and midpoints with entries
  std::vector<Entry> entries_;
  std::array<std::vector<Index>, 4> free_;  ///< unused blocks of 1, 2, 4 and 8 entries
  std::vector<double> displacements_;       ///< d per entry: from the vertex to the point, vertex frame; d = 2: empty
  double longest_ = 0;  ///< longest edge passed: a path of length L crosses no side with an end beyond L + `longest_`
  /// Radius of `run`, and the longest edge passed that a path of this length may cross: on triangulations one whose nearer end is at most
  /// half of the edge's length farther.
  double limit_ = 0, longest_within_ = 0;
  std::function<bool(Vertex)> is_closed_;  ///< vertices that the front does not enter; empty: none
  double missed_;                          ///< tolerance of `across_side`: share of a side by which a line may miss it
  bool is_curved_;  ///< whether paths carry the curvature of the front: on Delaunay triangulations
  bool directions_;
  bool of_curve_ = false;  ///< whether samples of a curve are among the points
  std::vector<double>
      curvatures_;           ///< curvature of vertices not in `one_rings_`, empty until used; NaN: not computed yet
  std::vector<Path> paths_;  ///< paths of the entries; empty without directions
  struct Queue : std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>> {
    void clear() { c.clear(); }
  };
  Queue queue_;
  std::shared_ptr<const OneRings> one_rings_;
  std::vector<CachedRing>
      ring_cache_;  ///< cache of one-rings that are not in `one_rings_`, indexed by the vertex modulo its size
  std::vector<Corner> ring_;  ///< one-ring of the current vertex
  std::vector<Neighbor> neighbors_;
  std::vector<NeighborState> states_;  ///< states of the neighbors of the current vertex
  std::vector<std::size_t> axis_;
  std::vector<const Entry*> nearest_;
  std::vector<Upwind> upwind_;
  Index points_ = 0;
};

}  // namespace ahm
