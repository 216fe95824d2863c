/// \file
/// Log maps in geodesic polar coordinates: the length of the shortest path to each vertex times the direction of that
/// path at the source.
///
/// \code
/// const ahm::PolarMapSolver solver(surface);                 // a mesh, a cloud, a grid: nothing is factored
/// ahm::LogMap map = solver.log_map(ahm::Row{42});
/// ahm::RowLogMap rows = surface.to_rows(map);                // the same as for heat maps
/// ahm::LocalMaps near = solver.local_maps(sources, {.k = 12});   // the twelve nearest vertices of many sources
/// \endcode
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/polar_map.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

struct PolarSolverOptions {
  /// Number of exact windows around the source per map. 0: none; the front starts at the source. Default: 8 per vertex of the
  /// source's component, at least 131,072, which take about as long as the front.
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
  /// Null for a graph without a surface.
  const Surface* surface() const noexcept { return surface_; }

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

  /// Local maps of vertices, in the axes of their frames. They contain the same numbers as `log_map` with the radius of the options.
  /// Each thread needs about 200 bytes per vertex of the graph for its fronts; otherwise time and memory depend on the number of
  /// entries.
  /// @param options  all but `margin` and the options of heat; of `heat` only `threads` and `progress`
  /// @throws InvalidArgument (options, another method, source), ResourceExhausted, Cancelled
  LocalMaps local_maps(std::span<const Vertex> sources, const LocalMapOptions& options) const;
  /// Local maps of points of the surface. @throws as `log_map`, `local_maps` of vertices
  LocalMaps local_maps(std::span<const SurfacePoint> sources, const LocalMapOptions& options,
                       const std::optional<Vec3>& u_axis = {}) const;
  /// Local maps of sources of any form except curves, without windows. @throws as `local_maps` of vertices
  LocalMaps local_maps(std::span<const Source> sources, const LocalMapOptions& options) const;

 private:
  class Fronts;
  /// Computes polar coordinates around a source by exact windows.
  using Seeds = std::function<ExactGeodesics::Seeds(const ExactMapOptions&, ExactGeodesics::Workspace&)>;
  /// Number of windows for a source at this vertex.
  Offset max_windows(Vertex source) const;
  Seeds seeds_of(Vertex source) const;
  Seeds seeds_of(const SurfacePoint& source, const std::optional<Vec3>& u_axis) const;
  LogMap log_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const;
  LocalMaps local_maps(std::span<const Source> sources, const LocalMapOptions& options,
                       const std::function<Seeds(std::size_t)>& seeds) const;

  const TangentGraph* graph_;
  const Surface* surface_ = nullptr;
  std::shared_ptr<const Wavefront::OneRings> one_rings_;
  /// Edges of the selected triangles, for clouds; null: the edges of the graph are used.
  std::unique_ptr<const CsrGraph> triangle_graph_;
  std::shared_ptr<const Wavefront::OneRings> triangle_one_rings_;
  std::optional<ExactGeodesics> geodesics_;  ///< none: no flat triangles, or windows disabled
  std::optional<Offset> windows_;            ///< as in the options
};

/// The method for log maps on a graph without a surface (else `Surface::suggested_method`): polar on Delaunay triangulations,
/// otherwise heat.
Method choose_method(const TangentGraph& graph);

}  // namespace ahm
