/// \file
/// Geodesic distances by unfolding: the distance to the nearest of any number of source points, and the number of that point.
///
/// \code
/// ahm::Wavefront front(graph);
/// front.add(ahm::Source::at_vertex(ahm::Vertex{3}));
/// front.add(ahm::Source::at_vertex(ahm::Vertex{9}));
/// front.run();
/// std::cout << front.distance(ahm::Vertex{5}) << " to source " << front.nearest(ahm::Vertex{5}) << '\n';
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <span>
#include <stop_token>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// A wavefront that grows from source points over a graph and visits vertices in the order of their distance [KS98, MR12].
///
/// The distances of two neighbors a and b from a point determine where the point lies in the plane of a triangle a b c. If the
/// straight line from there to c crosses the side a b, its length is the distance of c. Otherwise the distance of c is the one along
/// the edge a c. This takes O(n log n), about a microsecond per vertex, and needs no operators.
///
/// On a curved surface the front is not a circle. On Delaunay triangulations each path therefore carries the curvature of the front,
/// computed from the angle defects of the vertices (docs/concepts/accuracy.md).
///
/// The distances are exact on flat convex Delaunay triangulations, of second order on other Delaunay triangulations, and of first
/// order on other graphs. In components of up to 10,000 vertices that are not flat, the front also visits the midpoints of the edges,
/// which halves the error. Unlike heat, the front goes around holes and along both sides of a cut locus. If the edge lengths are
/// noisy, distances are too short, because the front takes the shortest of many uncertain paths.
///
/// In other dimensions than 2 the edges transport the displacement from the point. If all edges lie along orthogonal axes (grids in space),
/// the front also solves the factored eikonal equation [FLZ09]: it is exact where the straight line is free, and of first order behind
/// obstacles. On other graphs the distance is the length of the straight line.
class Wavefront {
 public:
  /// The one-rings of all vertices, computed once for many fronts: about 200 bytes per vertex.
  class OneRings;
  /// @param threads    0: one per core
  /// @param midpoints  whether to cut the triangles of small components at the midpoints of their sides
  static std::shared_ptr<const OneRings> one_rings(const TangentGraph& graph, unsigned threads = 1,
                                                   bool midpoints = true);

  /// @param graph       must outlive the front
  /// @param stars       one-rings of this graph; null: the front computes them vertex by vertex
  /// @param directions  whether to compute `direction` and `arrival`, too (d = 2)
  explicit Wavefront(const TangentGraph& graph, std::shared_ptr<const OneRings> stars = nullptr,
                     bool directions = false);

  /// Adds the points of a source. Points are numbered from 0 in the order in which they are added.
  /// @return the number of the first added point
  /// @throws InvalidArgument when the source does not fit the graph
  Index add(const Source& source);
  /// Number of points added so far.
  Index points() const noexcept { return points_; }
  const TangentGraph& graph() const noexcept { return graph_; }

  /// Exact polar coordinates of one vertex, for example from exact windows around the source.
  struct Seed {
    Vertex vertex;
    double distance;   ///< world units
    Vec2 direction;    ///< as `Wavefront::direction`
    Vec2 arrival;      ///< as `Wavefront::arrival`; NaN: unknown
    Index point = 0;   ///< number of the source point
    double error = 0;  ///< expected error of the direction, radians
  };
  /// Discards all results and starts again from the seeds. The front does not change the values of seeds. Each seed reuses the curvature of
  /// the front at its vertex from the discarded results, if there is one, so run the front over the seeds first. Requires directions.
  void restart(std::span<const Seed> seeds);

  /// Advances the front until all vertices nearer than `radius` (world units) have their final distance. Vertices beyond may have no
  /// distance, or one that is too long. May be called again after `add`; then only vertices nearer to the new points change.
  /// @throws Cancelled when a stop is requested
  void run(double radius = std::numeric_limits<double>::infinity(), const std::stop_token& stop = {});
  /// All distances below this one are final, world units; infinity if the front has visited all vertices it can reach.
  double next() const {
    return queue_.empty() ? std::numeric_limits<double>::infinity()
                          : (queue_.top().distance - longest_) * graph_.length_unit();
  }

  /// Distance to the nearest point, world units; infinity at vertices that the front has not reached.
  double distance(Vertex vertex) const;
  /// Unit direction in which the geodesic path leaves the nearest point, in the frame of the source. Distance times direction are geodesic
  /// polar coordinates [MR12]. NaN at the point itself and at vertices that the front has not reached.
  Vec2 direction(Vertex vertex) const;
  bool has_directions() const noexcept { return directions_; }
  /// Expected error of the direction, radians. At each side that the path crosses there are two estimates of the direction. The error is
  /// half the root of the sum of their squared differences. At a seed it is `Seed::error`. NaN at vertices that the front has not reached.
  double direction_error(Vertex vertex) const;
  /// Unit direction in which the geodesic path arrives at a vertex, in the frame of the vertex. Together with `direction` it determines the
  /// parallel transport along the path. NaN at the source and at vertices that the front has not reached.
  Vec2 arrival(Vertex vertex) const;
  /// Whether the frame of the vertex has the opposite orientation of the source's frame, transported along the path.
  bool is_mirrored(Vertex vertex) const;
  /// Number of the nearest point, any of them if several are equally near; -1 at vertices that the front has not reached.
  Index nearest(Vertex vertex) const;

 private:
  /// Distance of a vertex from one point. Vertices near the border between two points have entries for both, so that both fronts can unfold
  /// across it. The entries of a vertex are contiguous, the nearest first, in blocks of 1, 2, 4, 8 or 16.
  struct Entry {
    double distance = 0, focusing = 0;  ///< distance, and m of docs/concepts/accuracy.md
    Index point = -1;
    std::uint8_t gains = 0;  ///< how often the distance was improved
    std::uint8_t count = 0;  ///< number of entries of the vertex; valid in the first of them
  };
  /// The geodesic path of an entry.
  struct Way {
    Vec2 direction;                     ///< direction at the point, in the frame of the source
    Vec2 arrival{};                     ///< direction at the vertex, in its frame; {0, 0}: from `last`; NaN: unknown
    std::array<Index, 2> last{-1, -1};  ///< ends of the side that the path crosses last; equal: it follows an edge
    float share = 0;                    ///< where the path crosses that side: 0 at the first end, 1 at the second
    float variance = 0;                 ///< sum of squared differences of the direction estimates (`direction_error`)
    bool mirrored = false;              ///< as `is_mirrored`
  };
  /// A neighbor of a vertex, and the angle from it to the next neighbor counterclockwise.
  struct Corner {
    Index neighbor;
    bool reflects;  ///< whether the transport along the edge is a reflection
    double length;
    double cosine, sine;  ///< of the angle; NaN if there is no triangle between the two neighbors
  };
  /// The corners around a vertex.
  struct Seen {
    Index vertex = -1;
    std::vector<Corner> corners;
  };
  /// A neighbor of a vertex in its tangent plane.
  struct Neighbor {
    Index vertex;
    Vec2 log;
    double length, turn;
    std::size_t edge;
    bool reflects;
  };
  /// State of a neighbor while the front spreads from a vertex.
  struct Known {
    double distance, along, focusing;  ///< shortest distance so far, distance along the edge, m
    bool is_new;                       ///< whether this vertex has improved the distance
    Way way;
  };
  /// A neighbor from which the front comes along an axis (`eikonal_factor`).
  struct Upwind {
    double length, cosine, factor;
  };
  struct Waiting {
    double distance;
    Index vertex, point;
    bool operator>(const Waiting& other) const {
      return distance != other.distance ? distance > other.distance
                                        : (vertex != other.vertex ? vertex > other.vertex : point > other.point);
    }
  };

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
  /// A vertex near a point, with its position relative to the point from the source.
  struct Given {
    Index vertex, point;
    double distance;
    Vec2 offset, arrival;  ///< position in the frame of the source; direction at the vertex, in its frame
    bool mirrored;
  };

  void offer_midpoints(std::vector<Given>& given);
  void offer(Index vertex, Index point, double distance, double slack, std::span<const double> displacement,
             const Way& way, double focusing = 0);
  Index entry_to_take(Index vertex, Index point, double distance);
  void spread(Index from, Index point, double distance);
  void carry(Index from, Index point, double distance);
  double factor_at(Index vertex, Index point, std::span<const double> displacement, double distance);
  std::span<const double> displacement(const Entry& entry) const {
    return std::span(displacements_).subspan(number(entry) * d_, d_);
  }
  std::span<const Corner> around(Index vertex);
  double curvature(Index vertex);

  const TangentGraph& graph_;
  std::size_t d_;
  std::vector<Index> first_;  ///< first entry of each vertex or midpoint; -1: none
  std::vector<Entry> entries_;
  std::array<std::vector<Index>, 4> free_;  ///< unused blocks of 1, 2, 4 and 8 entries
  std::vector<double> displacements_;       ///< d per entry: from the vertex to the point, vertex frame; d = 2: empty
  double longest_ = 0;  ///< longest edge passed: a path of length L crosses no side with an end beyond L + `longest_`
  double missed_;       ///< tolerance of `across_side`: share of a side by which a line may miss it
  bool is_curved_;      ///< whether paths carry the curvature of the front: on Delaunay triangulations
  bool directions_;
  bool of_curve_ = false;           ///< whether samples of a curve are among the points
  std::vector<double> curvatures_;  ///< curvature of vertices not in `stars_`, empty until used; NaN: not computed yet
  std::vector<Way> ways_;           ///< paths of the entries; empty without directions
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue_;
  std::shared_ptr<const OneRings> stars_;
  std::vector<Seen> seen_;      ///< cache of one-rings that are not in `stars_`, indexed by the vertex modulo its size
  std::vector<Corner> around_;  ///< one-ring of the current vertex
  std::vector<Neighbor> neighbors_;
  std::vector<Known> known_;  ///< states of the neighbors of the current vertex
  std::vector<std::size_t> axis_;
  std::vector<const Entry*> nearest_;
  std::vector<Upwind> upwind_;
  Index points_ = 0;
};

}  // namespace ahm
