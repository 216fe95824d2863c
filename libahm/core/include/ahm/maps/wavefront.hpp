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
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/stop_token.hpp"

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
  /// The triangles around every vertex, which a front crosses. They take about 200 bytes per vertex.
  class OneRings;
  /// Computes the one-rings of a graph once for many fronts. A `CsrGraph` keeps them, and returns the same ones at the next call.
  /// @param threads    0: one per core
  /// @param midpoints  whether to cut the triangles of small components at the midpoints of their sides
  static std::shared_ptr<const OneRings> one_rings(const TangentGraph& graph, unsigned threads = 1,
                                                   bool midpoints = true);
  /// The one-rings for one front up to a radius. Null if the radius is finite: the front then needs few of them, and computes those itself.
  static std::shared_ptr<const OneRings> one_rings_within(const TangentGraph& graph, double radius,
                                                          unsigned threads = 1);

  /// @param graph       must outlive the front
  /// @param one_rings   one-rings of this graph; null: the front computes them vertex by vertex
  /// @param directions  whether to compute `direction` and `arrival`, too (d = 2)
  explicit Wavefront(const TangentGraph& graph, std::shared_ptr<const OneRings> one_rings = nullptr,
                     bool directions = false);
  ~Wavefront();
  Wavefront(Wavefront&&) noexcept;
  Wavefront& operator=(Wavefront&&) noexcept;

  /// Adds the points of a source. Points are numbered from 0 in the order in which they are added.
  /// @return the number of the first added point
  /// @throws InvalidArgument when the source does not fit the graph
  Index add(const Source& source);
  /// Number of points added so far.
  Index points() const noexcept;
  const TangentGraph& graph() const noexcept;

  /// Removes all points and results, for another front over the same graph. The time depends on the number of vertices that the
  /// front has reached, not on the size of the graph.
  void clear();

  /// Exact polar coordinates of one vertex, for example from exact windows around the source.
  struct Seed {
    Vertex vertex;
    double distance;        ///< world units
    Vec2 direction;         ///< as `Wavefront::direction`
    Vec2 arrival;           ///< as `Wavefront::arrival`; NaN: unknown
    Index point = 0;        ///< number of the source point
    double error = 0;       ///< expected error of the direction, radians
    bool mirrored = false;  ///< as `Wavefront::is_mirrored`
  };
  /// Discards all results and starts again from the seeds. The front does not change the values of seeds. Each seed reuses the curvature of
  /// the front at its vertex from the discarded results, if there is one, so if the front is to continue beyond the seeds, run it over
  /// them first. Neighbors of a point that are no seeds keep their results. Requires directions.
  /// @param is_closed  vertices that the front does not enter unless they are seeds; empty: none
  void restart(std::span<const Seed> seeds, std::function<bool(Vertex)> is_closed = {});

  /// Advances the front until all vertices nearer than `radius` (world units) have their final distance. Vertices beyond may have no
  /// distance, or one that is too long. May be called again after `add`; then only vertices nearer to the new points change.
  /// @throws Cancelled when a stop is requested
  void run(double radius = std::numeric_limits<double>::infinity(), const StopToken& stop = {});
  /// All distances below this one are final, world units; infinity if the front has visited all vertices it can reach.
  double next() const;

  /// The vertices with a distance, in the order in which the front first reached them.
  std::vector<Vertex> reached() const;

  /// Distance to the nearest point, world units; infinity at vertices that the front has not reached.
  double distance(Vertex vertex) const;
  /// Unit direction in which the geodesic path leaves the nearest point, in the frame of the source. Distance times direction are geodesic
  /// polar coordinates [MR12]. NaN at the point itself and at vertices that the front has not reached.
  Vec2 direction(Vertex vertex) const;
  bool has_directions() const noexcept;
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
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm
