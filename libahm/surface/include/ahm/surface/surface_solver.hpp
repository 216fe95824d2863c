/// \file
/// Log maps, distances and paths on a surface, by rows of the input.
///
/// \code
/// const ahm::SurfaceSolver solver(ahm::pointcloud::PointCloudSurface::build(points));   // any surface
/// const ahm::SurfaceLogMap map = solver.log_map(0);                     // from row 0: map.u[i], map.v[i], map.distance[i]
/// const auto near = solver.log_map({0.1, 0.2, 1.4}, {.radius = 0.5});   // from the nearest point of the surface
/// const auto many = solver.log_maps({0, 17, 333});
/// const std::vector<double> d = solver.distance({0, 90});               // from the nearer one of two rows
/// const ahm::SurfacePath path = solver.path(7, 90);
/// \endcode
#pragma once

#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/surface/surface_point.hpp"

namespace ahm {

/// A place on a surface: a row of the input, a position in space, or a point of a face, an edge or a tangent plane.
class Location {
 public:
  /// A row, counted from 0.
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool>) Location(Integer row)
      : place_(SurfacePoint(checked_row(std::in_range<Index>(row), static_cast<Index>(row)))) {}
  Location(Row row) : place_(SurfacePoint(row)) {}
  /// The point of the surface that is nearest to a position, world units.
  Location(const Vec3& position) : place_(position) {}
  template <std::floating_point Real>
  Location(Real x, Real y, Real z) : place_(Vec3{x, y, z}) {}
  Location(SurfacePoint point) : place_(std::move(point)) {}
  Location(FacePoint point) : place_(SurfacePoint(std::move(point))) {}
  Location(EdgePoint point) : place_(SurfacePoint(point)) {}
  Location(TangentPoint point) : place_(SurfacePoint(point)) {}

  /// @throws InvalidArgument (as `Surface::closest_point`)
  SurfacePoint on(const Surface& surface) const;

 private:
  /// @throws InvalidArgument (a row that no `Index` holds)
  static Row checked_row(bool in_range, Index row);

  std::variant<Vec3, SurfacePoint> place_;
};

/// Options of the automatic choice of the method (`Surface::suggested_method`).
struct AutomaticOptions {
  Index expected_maps = 0;  ///< for heat: the number of maps to be made; 0: many
  unsigned threads = 0;     ///< 0: one per core. No result depends on it
  Progress progress = {};
};

/// Options of the method `exact`.
struct ExactSolverOptions {
  unsigned threads = 0;  ///< 0: one per core. No result depends on it
};

/// The method of a solver, with its options.
using MethodOptions = std::variant<AutomaticOptions, PolarSolverOptions, HeatOptions, ExactSolverOptions>;

/// Options of `SurfaceSolver::log_map` and `log_maps`.
struct SurfaceMapOptions {
  /// A vector of space along which u runs, projected to the surface; as `Surface::source`.
  std::optional<Vec3> u_axis = {};
  /// Rows farther than this get `Status::beyond_radius`. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  bool frames = true;  ///< keep the transported frames (`LogMap::frames`), which gradients and inverse maps need
  Progress progress = {};
};

struct SurfaceDistanceOptions {
  /// Rows farther than this have no distance. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  Progress progress = {};
};

/// A log map by rows of the input: `u`, `v`, `distance`, `angle`, `status`, ... of `RowLogMap`, with its source and the map of the
/// graph, which `Surface` and the applications take.
struct SurfaceLogMap : RowLogMap {
  SurfaceSource source;
  LogMap vertices;  ///< one entry per vertex of the graph
};

/// Computes log maps, distances and paths on one surface. Prepares the method once (factors, one-rings or triangles) for any number
/// of maps. Immutable; all members may be called from many threads at once.
class SurfaceSolver {
 public:
  /// @param surface  must outlive the solver
  /// @throws as `LogMapSolver`, `PolarMapSolver` or `ExactGeodesics`
  explicit SurfaceSolver(const Surface& surface, const MethodOptions& options = {});
  /// Not available: a constant temporary would not outlive the solver. Pass a named surface, a `shared_ptr`, or move the surface.
  explicit SurfaceSolver(const Surface&&, const MethodOptions& = {}) = delete;
  /// Shares the ownership of a surface.
  explicit SurfaceSolver(std::shared_ptr<const Surface> surface, const MethodOptions& options = {});
  // NOLINTBEGIN(bugprone-forwarding-reference-overload,bugprone-move-forwarding-reference): rvalues only
  /// Moves a surface into the solver.
  template <class S>
  requires(std::derived_from<S, Surface> &&
           !std::is_const_v<S>) explicit SurfaceSolver(S&& surface, const MethodOptions& options = {})
      : SurfaceSolver(std::shared_ptr<const Surface>(std::make_shared<const S>(std::move(surface))), options) {}
  // NOLINTEND(bugprone-forwarding-reference-overload,bugprone-move-forwarding-reference)
  ~SurfaceSolver();
  SurfaceSolver(SurfaceSolver&&) noexcept;
  SurfaceSolver& operator=(SurfaceSolver&&) noexcept;

  const Surface& surface() const noexcept;
  /// The method in use.
  Method method() const noexcept;

  /// The log map of one source. For several sources `log_maps` is faster.
  /// @throws InvalidArgument (as `Surface::source`; radius), ResourceExhausted, Cancelled, NotPositiveDefinite (heat)
  SurfaceLogMap log_map(const Location& source, const SurfaceMapOptions& options = {}) const;
  /// One map per source, computed on several threads.
  /// @throws as `log_map`
  std::vector<SurfaceLogMap> log_maps(const std::vector<Location>& sources,
                                      const SurfaceMapOptions& options = {}) const;
  /// Quality of each row in (0, 1]; NaN where the map is not ok (`map_quality`). Do not use vectors below `reliable_quality`.
  /// @param map  made by this solver
  std::vector<double> quality(const SurfaceLogMap& map) const;
  /// (u, v) at a place. @throws InvalidArgument (as `Surface::at`)
  Sample at(const SurfaceLogMap& map, const Location& place) const;

  /// Geodesic distance of each row from the nearest source, world units: by a wavefront, or exact where that is the method. NaN where
  /// no source is connected.
  /// @throws InvalidArgument (as `Surface::source`; radius), ResourceExhausted, Cancelled
  std::vector<double> distance(const std::vector<Location>& sources, const SurfaceDistanceOptions& options = {}) const;
  std::vector<double> distance(const Location& source, const SurfaceDistanceOptions& options = {}) const;

  /// The shortest path: exact over flat faces, else over tangent planes (`shortest_line`).
  /// @throws InvalidArgument (as `Surface::source`; a surface with faces that are not flat)
  SurfacePath path(const Location& start, const Location& end) const;
  /// The straightest geodesic from a place along a vector of space, projected to the surface: the exponential map [PS98].
  /// @param length  world units, >= 0
  /// @throws as `path`
  SurfacePath trace(const Location& start, const Vec3& direction, double length) const;

  /// The log maps of every row within a radius, by heat if that is the method of the solver or of the options, otherwise polar. Rows
  /// without a vertex have no entries.
  /// @throws as `row_local_maps`
  RowLocalMaps local_maps(const LocalMapOptions& options) const;
  /// The log maps of some sources within a radius. @throws as `row_local_maps`
  RowLocalMaps local_maps(const std::vector<Location>& sources, const LocalMapOptions& options) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// `SurfaceSolver::distance` by a wavefront, without a solver. The first call without a radius builds the one-rings, and the graph keeps them
/// if it has a cache.
/// @throws InvalidArgument (as `Surface::source`; radius), ResourceExhausted, Cancelled
std::vector<double> distance(const Surface& surface, const std::vector<Location>& sources,
                             const SurfaceDistanceOptions& options = {});

/// One log map. For several sources make a `SurfaceSolver`. @throws as `SurfaceSolver`
SurfaceLogMap log_map(const Surface& surface, const Location& source, const SurfaceMapOptions& options = {},
                      const MethodOptions& method = AutomaticOptions{.expected_maps = 1});

}  // namespace ahm
