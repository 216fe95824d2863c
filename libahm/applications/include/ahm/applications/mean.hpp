/// \file
/// Weighted means and medians of points on a surface, computed by log maps.
///
/// \code
/// const std::array towns{ahm::Vertex{12}, ahm::Vertex{480}, ahm::Vertex{901}};
/// ahm::Center well = ahm::geometric_median(solver, towns);             // smallest sum of distances
/// ahm::Center mean = ahm::karcher_mean(solver, towns, std::array{1.0, 2.0, 1.0});
/// ahm::LogMap map = solver.solve(ahm::source_at(mean));                // the log map from the mean
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ahm/applications/any_solver.hpp"

namespace ahm {

struct CenterOptions {
  /// Where the search starts; none: the point of the largest weight, the first of equals. Points spread over more than half
  /// of a closed surface may have several centers: start at several vertices and use the result of smallest `spread`.
  std::optional<Vertex> start = {};
  Index max_maps = 50;  ///< maximum number of log maps; each step computes one
  /// Radius of the maps. It must cover every point, from the center and from the start. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
};

/// A point of the surface, as an offset from a vertex near it.
struct Center {
  Vertex vertex;
  std::vector<double> offset;  ///< log map of the center from the vertex: d numbers in the vertex's frame, world units
  /// The minimized quantity as a length, world units. Mean: sqrt(sum w d^2 / sum w); median: sum w d / sum w. The distances
  /// d from the center are measured in the tangent space of `vertex`, where log(p) has the direction of (u, v) and the
  /// length of the distance.
  double spread = 0;
  Index maps = 0;          ///< number of log maps computed
  bool converged = false;  ///< whether the center is within an edge of `vertex`; false also after `max_maps`
};

/// The Riemannian center of mass ([SS25] Sec. 5; [Kar77]): a local minimum of sum_k w_k d(x, p_k)^2 near the start.
///
///     x <- exp_x(sum_k w_k log_x(p_k) / sum_k w_k)
///
/// log_x(p) has the direction of the map's coordinates and the length of its distance. exp_x is rounded to the vertex with
/// the nearest coordinates; the remainder at the last vertex is the offset. A step to a vertex visited before is halved.
/// The result is the vertex with the smallest offset. Exact on flat graphs, after two or three maps; elsewhere the error is
/// that of the log map.
/// @param maps      a `LogMapSolver`, a `PolarMapSolver` or `ExactGeodesics`
/// @param vertices  the points p_k
/// @param weights   w_k >= 0, not all zero; empty: all equal. Points of weight 0 are ignored
/// @throws InvalidArgument (no vertices, lengths, index, weight, points in different components or beyond the reach of the
/// map); as `AnySolver::map`
Center karcher_mean(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights = {},
                    const CenterOptions& options = {});

/// The Karcher mean of points anywhere on the surface, each as a source (`Surface::source`). `LogMap::coordinates(point)`
/// evaluates the maps there. By default the search starts at the vertex with the largest weight in the heaviest point.
/// @throws InvalidArgument (as `karcher_mean`; a curve; a vertex that the graph does not have)
Center karcher_mean_of_points(const AnySolver& maps, std::span<const Source> points,
                              std::span<const double> weights = {}, const CenterOptions& options = {});

/// The geometric median: a local minimum of sum_k w_k d(x, p_k) near the start [FVJ09].
///
///     x <- exp_x(geometric median of log_x(p_k) in the tangent space)
///
/// Each step computes one map; Weiszfeld's and Newton's steps in the tangent space converge to rounding. Otherwise as
/// `karcher_mean`.
Center geometric_median(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights = {},
                        const CenterOptions& options = {});

/// The geometric median of points anywhere on the surface. @throws as `karcher_mean_of_points`
Center geometric_median_of_points(const AnySolver& maps, std::span<const Source> points,
                                  std::span<const double> weights = {}, const CenterOptions& options = {});

/// Position of a center in space, world units. Over flat faces the offset is traced from the vertex (`exact::trace`). The
/// trace ends at the boundary, or follows it where the offset leaves the surface. Without faces it runs over tangent planes
/// (`trace_line`). On twisted polygons the result is the nearest point of the surface.
/// @throws InvalidArgument (no positions; a center of another surface)
Vec3 center_position(const Surface& surface, const Center& center);

/// The source at a center; its axes are those of the frame of `center.vertex`.
Source source_at(const Center& center);

}  // namespace ahm
