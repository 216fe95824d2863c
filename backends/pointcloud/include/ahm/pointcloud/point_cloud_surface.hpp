/// \file
/// Scattered points as a surface: normals, local Delaunay triangulations, tufted intrinsic Delaunay Laplacian [SC20].
///
/// \code
/// auto cloud = ahm::pointcloud::PointCloudSurface::build(points);                  // std::vector<ahm::Vec3>
/// ahm::LogMapSolver solver(cloud.graph());
/// ahm::LogMap map = solver.solve(cloud.source(ahm::Row{0}).source);
/// ahm::RowLogMap result = cloud.to_rows(map);                                      // one row per input point
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/pointcloud/neighbor_search.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm::pointcloud {

struct LocalTriangles;

/// Meaning of the signs of the input normals.
enum class NormalSigns {
  /// The majority in each component decides which side is up; other normals are flipped. Neighbors with opposed normals are not
  /// joined if they lie consistently behind each other (thin walls).
  automatic,
  oriented,    ///< every sign is correct; neighbors with opposed normals are not joined
  unoriented,  ///< signs are ignored, only the planes are used
};

struct CloudOptions {
  /// Neighbors per point, without the point itself. Values above n - 1 are reduced to n - 1 and reported. Not set: 30.
  std::optional<Index> k;
  NeighborSearchFactory search = nanoflann_search;
  NormalSigns normal_signs = NormalSigns::automatic;
  /// Two points are joined only if their distance is at most this multiple of the distance to the k-th neighbor of each of them.
  double max_edge_ratio = 3.0;
  /// Smoothing of the points by moving least squares, before the graph is built. Not set: where the noise exceeds 0.12 of
  /// the spacing, over the k neighbors. 0: off. Otherwise all points are smoothed, with neighborhoods of this radius, world
  /// units, at most the size of the cloud. The time grows with the number of points within the radius.
  std::optional<double> smooth;
  /// Measure noise, and decide about smoothing, separately for each part that shares no neighbors with the rest, and for noisy regions
  /// of it. The result for a part then does not depend on the rest of the file. false: one decision for all points, as for tiled clouds.
  bool parts_apart = true;
  /// The rows to build from, ascending, for example those that remain after filters. Not set: all rows. Other rows get the status
  /// `removed` and may contain any values.
  std::optional<std::vector<Row>> rows;
  bool drop_non_finite = false;  ///< drop NaN and infinite points (status `removed`) instead of throwing
  unsigned threads = 0;          ///< 0: one per core. No result depends on it
  Progress progress;
};

/// Measured on clouds of 10,000 to 5,000,000 points.
inline constexpr BuildCost build_cost{.bytes = 500, .seconds = 10e-6};

/// Statistics of the construction.
struct CloudDetails {
  Index points = 0;      ///< rows of the input
  Index vertices = 0;    ///< vertices of the graph
  Index non_finite = 0;  ///< points dropped because a coordinate is NaN or infinite
  Index duplicates = 0;  ///< points merged into an equal one
  /// Rounding step of the largest coordinates, world units, if all coordinates are single-precision numbers; otherwise 0.
  double coordinate_step = 0;
  int coarse_axis = 0;                ///< axis of these coordinates: 0, 1, 2 for x, y, z
  Index near_duplicates = 0;          ///< points merged into another one much nearer than the spacing
  Index smoothed = 0;                 ///< points moved because of noise
  Index degenerate = 0;               ///< points without a tangent plane or without a triangle, removed
  std::vector<Row> first_degenerate;  ///< rows of the first ten degenerate points
  Index k_asked = 0;                  ///< neighbors per point requested, 30 by default
  Index k = 0;                        ///< neighbors per point used
  Index components = 0;               ///< connected components of the graph
  Offset triangles = 0;               ///< triangles in the union of the local Delaunay triangulations
  Offset flips = 0;                   ///< edge flips to the intrinsic Delaunay triangulation of the tufted cover
  bool flips_stopped = false;         ///< flips stopped before all edges were Delaunay
  Offset rejected_long = 0;           ///< neighbor pairs not joined: too long for the local spacing
  Offset rejected_normals = 0;        ///< neighbor pairs not joined: oriented normals disagree (thin wall)
  Offset rejected_steep = 0;   ///< neighbor pairs not joined: steeply above each other, beyond noise (other sheets)
  Offset reflections = 0;      ///< edges between oppositely oriented frames
  bool normals_given = false;  ///< the input has normals
  Index estimated = 0;         ///< input normals that are zero or not finite, and were estimated
  Index contradicted = 0;      ///< input normals that contradict the points: only their signs are used
  Index thick = 0;             ///< points with neighborhoods as thick as wide: no surface
  Index lines = 0;             ///< points in parts without an interior point: lines, not surfaces
  Index flipped_normals = 0;   ///< input normals opposed to the majority in their component, and flipped
  bool oriented = false;       ///< input normals determine the upper side everywhere
  double agreement = 1;  ///< fraction of the local triangles found in the local triangulations of all three corners
  /// Standard deviation of neighbors' offsets across the surface before smoothing, world units; for several parts, that of the
  /// largest.
  double noise = 0;
  /// Distance between layers that are nearer than neighbors and contain nearly all points, world units; 0: no layers.
  double layer_gap = 0;
  double mollification = 0;  ///< length added to every edge of the tufted cover, world units; the largest of the parts
  double seconds_normals = 0;    ///< time for neighbors and tangent planes
  double seconds_delaunay = 0;   ///< time for local triangulations
  double seconds_laplacian = 0;  ///< time for the tufted cover, flips and weights
  double seconds_graph = 0;      ///< time for orientation, logarithms and transports
};

/// A point cloud as a surface. Rows are the input points. Vertices are sorted along a space-filling curve; equal points and near
/// duplicates share a vertex. `positions()` returns the input points, and the origins of the frames are the smoothed points.
/// `closest_point` returns a point in the tangent plane of the nearest row. At a row, u is by default the x axis of
/// `graph().frame(vertex)`.
///
/// Entries of the report: points, vertices, non_finite, duplicates, near_duplicates, smoothed, degenerate, k, components,
/// triangles, flips, rejected_long, rejected_normals, rejected_steep, reflections, normals_given, contradicted, thick, lines,
/// oriented, noise, layer_gap, mollification, seconds.normals, seconds.delaunay, seconds.laplacian, seconds.graph.
///
/// Warnings, each with a count unless noted: normals_estimated; normals_contradicted; cover_not_delaunay (no number); degenerate
/// (with rows); normals_flipped; k_reduced (k requested, k used, distinct points); smoothed (points, noise); near_duplicates;
/// coarse_coordinates (step, mean edge length; the name of the axis); layers (gap); no_surface (points as thick as wide,
/// vertices); lines (points); non_finite; duplicates; thin_walls (pairs of neighbors not joined); reflections (edges);
/// cloud_components (components, if more than one).
///
/// Faults of a row: row_left_out (not in `CloudOptions::rows`), row_removed (not finite, no tangent plane, or no triangle).
class PointCloudSurface final : public Surface {
 public:
  /// Builds the graph. Time O(n k log k), memory O(n k).
  /// @param points   n >= 3 positions; equal points are merged
  /// @param normals  empty (then estimated by PCA) or one per point, of any length > 0
  /// @throws InvalidGeometry (fewer than 3 distinct points, non-finite values, all points collinear), InvalidArgument,
  /// ResourceExhausted, Cancelled
  static PointCloudSurface build(std::span<const Vec3> points, std::span<const Vec3> normals = {},
                                 const CloudOptions& options = {});

  const CsrGraph& graph() const& override { return *graph_; }
  void graph() const&& = delete;
  const RowMap& rows() const override { return rows_; }
  std::span<const Vec3> positions() const override { return positions_; }
  Report report() const override;
  std::vector<Warning> warnings() const override;
  const CloudDetails& details() const& noexcept { return details_; }
  void details() const&& = delete;
  /// A manifold chosen from the local triangulations. The first call computes it in time O(n log n). It may leave out vertices.
  /// @throws InvalidGeometry (no triangle remains)
  FlatTriangles flat_approximation() const override;

  /// Polar, except in two cases. Heat if the noise exceeds half of the mean edge length, which smoothing does not reduce
  /// enough. Heat also if less than 0.8 of the local triangles agree, because the points then do not form a surface.
  Method suggested_method() const override;

  ~PointCloudSurface() override;
  PointCloudSurface(PointCloudSurface&&) noexcept;
  PointCloudSurface& operator=(PointCloudSurface&&) noexcept;

 protected:
  Reason missing_vertex_reason(Row row) const override;
  double normal_error_degrees() const override;

 private:
  PointCloudSurface(CsrGraph graph, CloudDetails details, RowMap rows, std::span<const Vec3> points,
                    std::optional<std::vector<Row>> kept, LocalTriangles triangles);

  std::unique_ptr<const CsrGraph> graph_;
  CloudDetails details_;
  RowMap rows_;
  std::vector<Vec3> positions_;
  std::optional<std::vector<Row>> kept_;
  struct Sheet;
  std::unique_ptr<Sheet> sheet_;  ///< computed by the first `flat_approximation`
};

}  // namespace ahm::pointcloud
