/// \file
/// From scattered points to a tangent graph: normals, local Delaunay triangulations, tufted intrinsic Delaunay
/// Laplacian.
///
/// \code
/// auto cloud = ahm::pointcloud::PointCloudGraph::build(points);                  // std::vector<ahm::Vec3>
/// ahm::LogMapSolver solver(cloud.graph());
/// ahm::LogMap map = solver.solve(cloud.source_at_point(0));
/// ahm::pointcloud::PointMap result = cloud.on_points(map);                       // one row per input point
/// \endcode
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/progress.hpp"

namespace ahm::pointcloud {

/// What the signs of given normals mean.
enum class NormalSigns {
  /// The majority in each component fixes which side is up; others are turned. Neighbours that face away from each other are
  /// kept apart if they lie consistently behind each other (thin walls).
  automatic,
  oriented,    ///< trusted one by one; neighbours whose normals are opposed are kept apart
  unoriented,  ///< only the planes are used
};

/// How long the logarithm of an edge is; its direction is that of the neighbour projected to the tangent plane.
enum class EdgeLength {
  projected,  ///< the length of the projection: as accurate as the chord on clean clouds, and blind to noise across the
              ///< surface
  chord,      ///< the distance in space: noise of 30 % of the spacing makes every distance 12 % too long
};

struct CloudOptions {
  Index k = 30;  ///< neighbours per point, the point itself not counted; clamped to n - 1 and reported
  NeighborSearchFactory search = nanoflann_search;
  NormalSigns normal_signs = NormalSigns::automatic;
  EdgeLength edge_length = EdgeLength::projected;
  /// Two points are joined only if their distance is at most this multiple of the distance to the k-th neighbour of
  /// either.
  double max_edge_ratio = 3.0;
  bool drop_non_finite = false;  ///< NaN and infinite points: drop (status `removed`) instead of throwing
  unsigned threads = 0;          ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// What was found and done on the way. Counts are of points, edges or triangles as named.
struct CloudReport {
  Index points = 0;              ///< input points
  Index vertices = 0;            ///< vertices of the graph
  Index non_finite = 0;          ///< points dropped because a coordinate is NaN or infinite
  Index duplicates = 0;          ///< points merged into an equal one
  Index degenerate = 0;          ///< points without a tangent plane or without a triangle, removed
  Index k = 0;                   ///< neighbours used
  Index components = 0;          ///< connected components of the graph
  Offset triangles = 0;          ///< of the union of the local Delaunay triangulations
  Offset flips = 0;              ///< edge flips to the intrinsic Delaunay triangulation of the tufted cover
  Offset rejected_long = 0;      ///< neighbour pairs not joined: too long for the local spacing
  Offset rejected_normals = 0;   ///< neighbour pairs not joined: oriented normals disagree (thin wall)
  Offset reflections = 0;        ///< edges between oppositely oriented frames
  Index turned = 0;              ///< given normals that pointed to the other side than the majority around them
  bool oriented = false;         ///< given normals fix which side is up, everywhere
  double mollification = 0;      ///< length added to every edge of the tufted cover, world units
  double seconds_normals = 0;    ///< neighbours and tangent planes
  double seconds_delaunay = 0;   ///< local triangulations
  double seconds_laplacian = 0;  ///< tufted cover, flips, weights
  double seconds_graph = 0;      ///< orientation, logs, transports
  std::vector<std::string> warnings;
};

/// A log map on the input points: row i belongs to input point i.
struct PointMap {
  std::vector<double> u, v;      ///< NaN where the status is not ok
  std::vector<double> distance;  ///< |(u, v)|
  std::vector<double> angle;     ///< atan2(v, u), in (-pi, pi]
  std::vector<Status> status;
};

/// The tangent graph of a point cloud and its relation to the input points.
class PointCloudGraph {
 public:
  /// Builds the graph. Time O(n k log k), memory O(n k).
  /// @param points   n >= 3 positions; equal points are merged
  /// @param normals  empty (estimated by PCA) or one per point, any length > 0
  /// @throws InvalidGeometry (fewer than 3 distinct points, non-finite values, all points collinear), InvalidArgument,
  /// Cancelled
  static PointCloudGraph build(std::span<const Vec3> points, std::span<const Vec3> normals = {},
                               const CloudOptions& options = {});

  /// Stays where it is when this object is moved.
  const CsrGraph& graph() const& noexcept { return *graph_; }
  void graph() && = delete;
  const CloudReport& report() const& noexcept { return report_; }
  void report() && = delete;

  /// Vertex of each input point, -1 where it was removed.
  std::span<const Index> vertex_of_point() const noexcept { return vertex_of_point_; }
  /// First input point of each vertex.
  std::span<const Index> point_of_vertex() const noexcept { return point_of_vertex_; }

  /// The source at an input point; u and v are the tangent axes of `graph().frame(vertex)`.
  /// @throws InvalidArgument when the index is out of range or the point was removed
  Source source_at_point(Index point) const;
  /// The source at an input point whose u axis is the given vector of space projected to the tangent plane.
  /// @throws InvalidArgument also when the projection vanishes
  Source source_at_point(Index point, const Vec3& u_direction) const;

  /// The input point, among those that are vertices, nearest to a position in space.
  Index nearest_point(const Vec3& position) const;

  /// A result per vertex as a result per input point.
  PointMap on_points(const LogMap& map) const;
  /// Unit normal per input point as used by the graph (orientation included); NaN where removed.
  std::vector<Vec3> normals_on_points() const;

 private:
  PointCloudGraph(CsrGraph graph, CloudReport report, std::vector<Index> vertex_of_point,
                  std::vector<Index> point_of_vertex);

  std::unique_ptr<const CsrGraph> graph_;
  CloudReport report_;
  std::vector<Index> vertex_of_point_;
  std::vector<Index> point_of_vertex_;
};

}  // namespace ahm::pointcloud
