/// \file
/// Scattered points as a surface: normals, local Delaunay triangulations, tufted intrinsic Delaunay Laplacian [SC20].
///
/// \code
/// auto cloud = ahm::pointcloud::PointCloudSurface::build(points);                  // std::vector<ahm::Vec3>
/// ahm::LogMapSolver solver(cloud.graph());
/// ahm::LogMap map = solver.solve(cloud.source(ahm::Row{0}).source);
/// ahm::RowLogMap result = cloud.on_rows(map);                                      // one row per input point
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

/// What the signs of given normals mean.
enum class NormalSigns {
  /// The majority in each component fixes which side is up; others are turned. Neighbours that face away from each other are
  /// kept apart if they lie consistently behind each other (thin walls).
  automatic,
  oriented,    ///< trusted one by one; neighbours whose normals are opposed are kept apart
  unoriented,  ///< only the planes are used
};

struct CloudOptions {
  /// Neighbours per point, the point itself not counted; clamped to n - 1 and reported. None: 30.
  std::optional<Index> k;
  NeighborSearchFactory search = nanoflann_search;
  NormalSigns normal_signs = NormalSigns::automatic;
  /// Two points are joined only if their distance is at most this multiple of the distance to the k-th neighbour of
  /// either.
  double max_edge_ratio = 3.0;
  /// Smoothing of the points, before the graph is built, by moving least squares. None: where the noise is larger than an eighth of the
  /// spacing, over the k neighbors. 0: off. Else the radius of the neighborhoods, world units, everywhere.
  std::optional<double> smooth;
  /// Whether noise, and with it smoothing, is measured for each part that shares no neighbours with the rest,
  /// so that a part does not depend on what else is in the file. Else for all as one, as clouds in tiles are built.
  bool parts_apart = true;
  /// The points to build from, ascending, after whatever filters a caller applied; none: all. Other rows are `removed`, and
  /// may hold anything.
  std::optional<std::vector<Row>> rows;
  bool drop_non_finite = false;  ///< NaN and infinite points: drop (status `removed`) instead of throwing
  unsigned threads = 0;          ///< 0: one per core; the result does not depend on it
  Progress progress;
};

/// Measured on clouds of 10,000 to 5,000,000 points.
inline constexpr BuildCost build_cost{.bytes = 500, .seconds = 10e-6};

/// What was found and done on the way. Counts are of points, edges or triangles as named.
struct CloudDetails {
  Index points = 0;      ///< rows of the input
  Index vertices = 0;    ///< vertices of the graph
  Index non_finite = 0;  ///< points dropped because a coordinate is NaN or infinite
  Index duplicates = 0;  ///< points merged into an equal one
  /// Largest step between coordinates that are all single precision numbers, far from the origin; world units. 0: others are not.
  double coordinate_step = 0;
  Index near_duplicates = 0;          ///< points merged into one much nearer than the spacing
  Index smoothed = 0;                 ///< points moved because of noise
  Index degenerate = 0;               ///< points without a tangent plane or without a triangle, removed
  std::vector<Row> first_degenerate;  ///< the first ten of them
  Index k_asked = 0;                  ///< neighbours asked for, 30 by default
  Index k = 0;                        ///< neighbours used
  Index components = 0;               ///< connected components of the graph
  Offset triangles = 0;               ///< of the union of the local Delaunay triangulations
  Offset flips = 0;                   ///< edge flips to the intrinsic Delaunay triangulation of the tufted cover
  bool flips_stopped = false;         ///< before all edges were Delaunay
  Offset rejected_long = 0;           ///< neighbour pairs not joined: too long for the local spacing
  Offset rejected_normals = 0;        ///< neighbour pairs not joined: oriented normals disagree (thin wall)
  Offset rejected_steep = 0;   ///< neighbour pairs not joined: steeply above each other, beyond noise (other sheets)
  Offset reflections = 0;      ///< edges between oppositely oriented frames
  bool normals_given = false;  ///< one per point
  Index estimated = 0;         ///< given normals that are zero or not finite and were estimated
  Index contradicted = 0;      ///< given normals whose planes the points contradict: only their sides were taken
  Index thick = 0;             ///< points whose neighbours are as thick as wide: no surface there
  Index lines = 0;             ///< points in parts without a point that others surround: lines, and no surface
  Index turned = 0;            ///< given normals that pointed to the other side than the majority around them
  bool oriented = false;       ///< given normals fix which side is up, everywhere
  double agreement = 1;  ///< share of the local triangles that all three corners have in their local triangulations
  double noise = 0;  ///< standard deviation of neighbours' offsets across the surface before smoothing, world units;
                     ///< of several parts that of the largest
  double layer_gap = 0;  ///< of layers nearer than neighbours that nearly all points there lie in, world units; 0: none
  double mollification = 0;  ///< length added to every edge of the tufted cover, world units; the largest of the parts
  double seconds_normals = 0;    ///< neighbours and tangent planes
  double seconds_delaunay = 0;   ///< local triangulations
  double seconds_laplacian = 0;  ///< tufted cover, flips, weights
  double seconds_graph = 0;      ///< orientation, logs, transports
};

/// A point cloud as a surface. Rows are the points given; vertices are sorted along a space-filling curve, equal points
/// and near duplicates share one. `positions()` are the points given, the origins of the frames the smoothed ones. The
/// closest point to a position lies in the tangent plane of the row nearest to it; at a row without an axis, u is x of
/// `graph().frame(vertex)`.
///
/// Its report: points, vertices, non_finite, duplicates, near_duplicates, smoothed, degenerate, k, components, triangles, flips, rejected_long,
/// rejected_normals, rejected_steep, reflections, normals_given, contradicted, thick, lines, oriented, noise, layer_gap, mollification, seconds.normals, seconds.delaunay,
/// seconds.laplacian, seconds.graph.
/// Its warnings, each with a count unless said otherwise: normals_estimated; normals_contradicted; cover_not_delaunay (no number);
/// degenerate (with rows); normals_turned; k_reduced (asked for, used, distinct points); smoothed (points, noise); near_duplicates; coarse_coordinates (step, mean edge length); layers (gap); no_surface (points as
/// thick as wide, vertices); lines (points); non_finite; duplicates; thin_walls (pairs of
/// neighbours not joined); reflections (edges); cloud_components (of more than one).
/// Faults of a row: row_left_out (by `CloudOptions::rows`), row_removed (not finite, no tangent plane, no triangle).
class PointCloudSurface final : public Surface {
 public:
  /// Builds the graph. Time O(n k log k), memory O(n k).
  /// @param points   n >= 3 positions; equal points are merged
  /// @param normals  empty (estimated by PCA) or one per point, any length > 0
  /// @throws InvalidGeometry (fewer than 3 distinct points, non-finite values, all points collinear), InvalidArgument,
  /// ResourceExhausted, Cancelled
  static PointCloudSurface build(std::span<const Vec3> points, std::span<const Vec3> normals = {},
                                 const CloudOptions& options = {});

  const CsrGraph& graph() const& override { return *graph_; }
  void graph() && = delete;
  const RowMap& rows() const override { return rows_; }
  std::span<const Vec3> positions() const override { return positions_; }
  Report report() const override;
  std::vector<Warning> warnings() const override;
  const CloudDetails& details() const& noexcept { return details_; }
  void details() && = delete;
  /// A manifold chosen from the local triangulations, by the first call: time O(n log n). It need not use all vertices.
  /// @throws InvalidGeometry (no triangle is left)
  FlatTriangles flat_approximation() const override;

  /// Polar, but heat where the noise is more than half of the mean edge length, which smoothing leaves too much of, and where the local
  /// triangulations agree in less than 0.8 of their triangles: the points do not form a surface.
  Method suggested_method() const override;

  ~PointCloudSurface() override;
  PointCloudSurface(PointCloudSurface&&) noexcept;
  PointCloudSurface& operator=(PointCloudSurface&&) noexcept;

 protected:
  Reason why_without_vertex(Row row) const override;
  double error_of_normals() const override;

 private:
  PointCloudSurface(CsrGraph graph, CloudDetails details, RowMap rows, std::span<const Vec3> points,
                    std::optional<std::vector<Row>> kept, LocalTriangles triangles);

  std::unique_ptr<const CsrGraph> graph_;
  CloudDetails details_;
  RowMap rows_;
  std::vector<Vec3> positions_;
  std::optional<std::vector<Row>> kept_;
  struct Sheet;
  std::unique_ptr<Sheet> sheet_;  ///< chosen by the first `flat_approximation`
};

}  // namespace ahm::pointcloud
