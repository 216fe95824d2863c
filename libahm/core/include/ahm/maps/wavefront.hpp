/// \file
/// Geodesic distance by unfolding: from any number of source points at once, with the nearest of them.
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

/// A front that grows from source points over a graph, nearest vertices first [KS98, MR12].
///
/// Two neighbours a, b whose distances from a point are known fix where it lies in the plane of a triangle a b c of the
/// star of a; where the straight line from there to c crosses the side a b, its length is the distance of c, else the way
/// along the edge a c is. No heat, no operator: O(n log n), about a microsecond a vertex.
///
/// On a curved surface the distances between a and b are not those of a circle: on Delaunay triangulations the curvature of
/// the front is carried along each way, from the angles around the vertices (maps/focusing.hpp).
///
/// It is exact on flat convex Delaunay triangulations, and of second order elsewhere on Delaunay triangulations, of first
/// order on other graphs. Coarse and sharp ones (connected components of up to 10,000 vertices, some of them bent) it crosses by
/// the midpoints of the edges, too, which halves the error; unlike heat it knows the way
/// around a hole and along both sides of a cut locus. Where a graph's lengths are noisy it takes the shortest of many
/// uncertain ways and is too short.
///
/// In other dimensions than 2 the displacement from the point is carried along the edges. Where edges lie along orthogonal axes
/// (grids in space) the front solves the eikonal equation beside it [FLZ09] (maps/eikonal.hpp): exact where the straight line is
/// free, of first order behind obstacles. Elsewhere distances are those of the straight line.
class Wavefront {
 public:
  /// The triangles around every vertex, made once for many fronts: about 200 bytes a vertex.
  class OneRings;
  /// @param threads    0: one per core
  /// @param midpoints  whether triangles of small components are cut at the midpoints of their sides
  static std::shared_ptr<const OneRings> one_rings(const TangentGraph& graph, unsigned threads = 1,
                                                   bool midpoints = true);

  /// @param graph       must outlive the front
  /// @param stars       of this graph; none: looked up vertex by vertex
  /// @param directions  whether to keep `direction`, too (d = 2)
  explicit Wavefront(const TangentGraph& graph, std::shared_ptr<const OneRings> stars = nullptr,
                     bool directions = false);

  /// Adds the points of a source, which get the next numbers, from 0.
  /// @return the number of the first
  /// @throws InvalidArgument when the source does not fit the graph
  Index add(const Source& source);
  /// How many points were added.
  Index points() const noexcept { return points_; }
  const TangentGraph& graph() const noexcept { return graph_; }

  /// Exact polar coordinates of one vertex, for example from exact windows around the source.
  struct Seed {
    Vertex vertex;
    double distance;   ///< world units
    Vec2 direction;    ///< as `direction`
    Vec2 arrival;      ///< as `arrival`; NaN: not known
    Index point = 0;   ///< number of the source point
    double error = 0;  ///< expected, of the direction, radians
  };
  /// Discards what the front has found and starts again from the seeds, whose values stay as they are. A seed keeps the focusing that
  /// the front has found at its vertex, if any, so run the front over them first. Requires directions.
  void restart(std::span<const Seed> seeds);

  /// Lets the front go on until all that is nearer than `radius` (world units) has its distance; what lies beyond may have one
  /// or not, perhaps too long a one. May be called again after `add`: only what is nearer to the new points changes.
  /// @throws Cancelled when a stop is requested
  void run(double radius = std::numeric_limits<double>::infinity(), const std::stop_token& stop = {});
  /// All that is nearer than this has its distance, world units; infinity at the front's end.
  double next() const {
    return queue_.empty() ? std::numeric_limits<double>::infinity()
                          : (queue_.top().distance - longest_) * graph_.length_unit();
  }

  /// The distance to the nearest point, world units; infinity where the front did not come.
  double distance(Vertex vertex) const;
  /// The direction in which the way leaves its nearest point, in the frame of the source, unit length: so distance times direction are
  /// geodesic polar coordinates [MR12]. NaN where the front did not come, and at the point itself.
  Vec2 direction(Vertex vertex) const;
  bool has_directions() const noexcept { return directions_; }
  /// Expected error of the direction, radians: half the root of the sum of squares by which the two estimates differed at each side
  /// that the path crosses. That of the seed at a seed, NaN where the front did not come.
  double direction_error(Vertex vertex) const;
  /// The direction in which the path arrives at a vertex, in the vertex' frame, unit length; NaN at the source and where the front
  /// did not come. With `direction` it is the parallel transport along the path.
  Vec2 arrival(Vertex vertex) const;
  /// Whether the frame of the vertex is a mirror image of the source's, carried along the path.
  bool is_mirrored(Vertex vertex) const;
  /// The number of the nearest point; -1 where the front did not come. Of equally near ones any.
  Index nearest(Vertex vertex) const;

 private:
  /// A distance from one point. Beside a border between points both sides are known, so that both can unfold across it. Those
  /// of a vertex lie side by side, the nearest first, in rows of 1, 2, 4, 8 or 16.
  struct Entry {
    double distance = 0, focusing = 0;
    Index point = -1;
    std::uint8_t gains = 0;
    std::uint8_t count = 0;  ///< of the vertex' entries, in the first of them
  };
  /// How the way of an entry leaves its point, in the frame of the source.
  struct Way {
    Vec2 direction;
    Vec2 arrival{};                     ///< {0, 0}: that from `last`; NaN: unknown
    std::array<Index, 2> last{-1, -1};  ///< ends of the side that it crosses last, or one of them twice
    float share = 0;                    ///< of that side, from the first end to where it crosses
    float variance = 0;                 ///< of the direction: sum of squares of the differences at the sides crossed
    bool mirrored = false;              ///< whether the frame of the vertex is turned over against that of the source
  };
  /// A neighbour of a vertex, and the angle from it to the next one counterclockwise.
  struct Corner {
    Index neighbor;
    bool reflects;  ///< its frame is turned over against that of the vertex
    double length;
    double cosine, sine;  ///< NaN where the star is open
  };
  /// The corners around a vertex.
  struct Seen {
    Index vertex = -1;
    std::vector<Corner> corners;
  };
  /// A neighbour of a vertex as it lies in the tangent plane.
  struct Neighbor {
    Index vertex;
    Vec2 log;
    double length, turn;
    std::size_t edge;
    bool reflects;
  };
  /// What is known of a neighbour while a vertex spreads: its distance, that along the edge, how the front comes to it, and
  /// whether all this was not known before.
  struct Known {
    double distance, along, focusing;
    bool is_new;
    Way way;
  };
  /// A neighbour from which the front comes along an axis (maps/eikonal.hpp).
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
  /// A vertex whose place beside a point is known, in the frame of the source.
  struct Given {
    Index vertex, point;
    double distance;
    Vec2 offset, arrival;
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
  std::vector<Index> first_;  ///< entry of a vertex or midpoint; -1: none
  std::vector<Entry> entries_;
  std::array<std::vector<Index>, 4> free_;  ///< rows of 1, 2, 4 and 8 entries that are no longer in use
  std::vector<double> displacements_;       ///< d per entry, from the vertex to the point in its frame; d = 2: empty
  double longest_ = 0;  ///< edge of what was passed: no straight way within a radius crosses a side farther beyond it
  double missed_;       ///< share of a side by which a line may miss it
  bool is_curved_;      ///< whether the curvature of the surface counts: on Delaunay triangulations
  bool directions_;
  bool of_curve_ = false;           ///< whether samples of a curve are among the points
  std::vector<double> curvatures_;  ///< of what is not in `stars_`, once one is asked for; NaN: not yet
  std::vector<Way> ways_;           ///< of the entries, where directions are kept
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue_;
  std::shared_ptr<const OneRings> stars_;
  std::vector<Seen> seen_;      ///< stars that `stars_` does not keep, by their vertex modulo the number of these
  std::vector<Corner> around_;  ///< of the vertex at hand
  std::vector<Neighbor> neighbors_;
  std::vector<Known> known_;  ///< of its neighbours
  std::vector<std::size_t> axis_;
  std::vector<const Entry*> nearest_;
  std::vector<Upwind> upwind_;
  Index points_ = 0;
};

}  // namespace ahm
