/// \file
/// Log maps in geodesic polar coordinates: the length of the shortest path to each vertex times the direction of that
/// path at the source.
///
/// \code
/// const ahm::PolarMapSolver solver(surface);                 // a mesh, a cloud, a grid: nothing is factored
/// ahm::LogMap map = solver.log_map(ahm::Row{42});
/// ahm::RowLogMap rows = surface.to_rows(map);                // the same as for heat maps
/// \endcode
#pragma once

#include <memory>
#include <optional>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/polar_map.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

struct PolarSolverOptions {
  /// Number of exact windows around the source per map. 0: none; the front starts at the source. Default: 8 per vertex, at
  /// least 131,072, which take about as long as the front.
  std::optional<Offset> windows = {};
  unsigned threads = 0;  ///< threads that build the one-rings; 0: one per core. No result depends on it
};

/// A surface prepared for polar maps: its one-rings and, if it has any, its flat triangles. Immutable; all members may be
/// called from many threads at once. Refers to the surface or graph, which must not move or end before the solver.
///
/// Exact windows (`ExactGeodesics`) compute distances and directions around the source. A front (`Wavefront`) continues from
/// there. The front starts at the source where there are no flat triangles (grids, faces without area), and where windows get
/// lost in needle triangles. `LogMap::error_estimate` is larger then. On clouds, windows cross triangles selected from the
/// local triangulations. The error estimate there is the difference to a front from the source.
class PolarMapSolver {
 public:
  /// @throws ResourceExhausted
  explicit PolarMapSolver(const Surface& surface, const PolarSolverOptions& options = {});
  /// Not available: a temporary surface would not outlive the solver.
  explicit PolarMapSolver(const Surface&&, const PolarSolverOptions& = {}) = delete;
  /// For a graph of dimension 2 without a surface. Its fronts start at the source.
  /// @throws InvalidArgument (dimension), ResourceExhausted
  explicit PolarMapSolver(const TangentGraph& graph, const PolarSolverOptions& options = {});
  /// Not available: a temporary graph would not outlive the solver.
  explicit PolarMapSolver(const TangentGraph&&, const PolarSolverOptions& = {}) = delete;

  const TangentGraph& graph() const noexcept { return *graph_; }

  /// The map from a point of the surface.
  /// @param u_axis  as in `Surface::source`
  /// @throws InvalidArgument (a solver for a graph; as `Surface::source`, `polar_map`), ResourceExhausted, Cancelled
  LogMap log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                 const PolarMapOptions& options = {}) const;
  /// The map from a vertex of the graph, in the axes of its frame. @throws as `log_map` of a point
  LogMap log_map(Vertex source, const PolarMapOptions& options = {}) const;
  /// The map from a source of any form except a curve, without windows. With several source points each vertex uses the nearest
  /// one (`LogMap::nearest`). @throws as `log_map` of a point
  LogMap log_map(const Source& source, const PolarMapOptions& options = {}) const;

 private:
  template <class Seeds>
  LogMap seeded_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const;

  const TangentGraph* graph_;
  const Surface* surface_ = nullptr;
  std::shared_ptr<const Wavefront::OneRings> one_rings_;
  /// Edges of the selected triangles, for clouds; null: the edges of the graph are used.
  std::unique_ptr<const CsrGraph> triangle_graph_;
  std::shared_ptr<const Wavefront::OneRings> triangle_one_rings_;
  std::optional<ExactGeodesics> geodesics_;  ///< none: no flat triangles, or windows disabled
  Offset windows_ = 0;
};

/// The method for log maps on a graph without a surface (else `Surface::suggested_method`): polar on Delaunay triangulations,
/// otherwise heat.
Method choose_method(const TangentGraph& graph);

}  // namespace ahm
