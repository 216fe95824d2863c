/// \file
/// Weighted means and medians of points of a surface, found by log maps.
///
/// \code
/// const std::array towns{ahm::Vertex{12}, ahm::Vertex{480}, ahm::Vertex{901}};
/// ahm::Center well = ahm::geometric_median(solver, towns);             // least sum of distances
/// ahm::Center mean = ahm::karcher_mean(solver, towns, std::array{1.0, 2.0, 1.0});
/// ahm::LogMap map = solver.solve(ahm::source_at(mean));                // the surface seen from there
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ahm/applications/any_solver.hpp"

namespace ahm {

struct CenterOptions {
  /// Where to begin; none: the point of the largest weight, the first of equals. Points spread over more than half of a
  /// closed surface may have several centers: begin at several vertices and keep the least `spread`.
  std::optional<Vertex> start = {};
  Index max_maps = 50;  ///< each step is one log map
  /// Of the maps; must reach from the center and the start to every point. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
};

/// A point of the surface, given by a vertex near it.
struct Center {
  Vertex vertex;
  std::vector<double> offset;  ///< log map of the center from the vertex: d numbers in its frame, world units
  /// What is least, as a length in world units. Mean: sqrt(sum w d^2 / sum w); median: sum w d / sum w. The distances
  /// d from the center are those in the tangent space of `vertex`, where log(p) has the direction of (u, v) and the length of the
  /// distance.
  double spread = 0;
  Index maps = 0;          ///< log maps used
  bool converged = false;  ///< false: `max_maps` ended the search
};

/// The Riemannian center of mass ([SS25] Sec. 5; [Kar77]): where sum_k w_k d(x, p_k)^2 is least, near the start.
///
///     x <- exp_x(sum_k w_k log_x(p_k) / sum_k w_k)
///
/// log_x(p) has the direction of the map's coordinates and the length of its distance, and exp_x leads to the vertex where it is
/// nearest; what remains at the last vertex is the offset. A step back to a vertex seen before is halved, and the vertex with the
/// least offset counts. Exact on flat graphs, where it takes two or three maps; elsewhere the error is that of the log map.
/// @param maps      a `LogMapSolver`, or `ExactGeodesics`
/// @param vertices  the points p_k
/// @param weights   w_k >= 0, not all zero; empty: all equal. Points of weight 0 do not count
/// @throws InvalidArgument (empty, lengths, index, weight, points of different components or out of the map's reach);
/// as `AnySolver::map`
Center karcher_mean(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights = {},
                    const CenterOptions& options = {});

/// The same of points anywhere, each given as a source (`Surface::source`); `LogMap::coordinates(point)` says where it is
/// seen. The search begins at the vertex with the largest share in the point where it would.
/// @throws InvalidArgument (as above; a curve; a vertex that the graph does not have)
Center karcher_mean_of_points(const AnySolver& maps, std::span<const Source> points,
                              std::span<const double> weights = {}, const CenterOptions& options = {});

/// The geometric median: where sum_k w_k d(x, p_k) is least, near the start [FVJ09].
///
///     x <- exp_x(geometric median of log_x(p_k) in the tangent space)
///
/// One map per step: Weiszfeld's and Newton's steps run in the tangent space, to rounding. Otherwise as `karcher_mean`.
Center geometric_median(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights = {},
                        const CenterOptions& options = {});

/// The same of points anywhere. @throws as `karcher_mean_of_points`
Center geometric_median_of_points(const AnySolver& maps, std::span<const Source> points,
                                  std::span<const double> weights = {}, const CenterOptions& options = {});

/// Where a center lies in space, world units: straight on from its vertex along the offset, over flat faces (`exact::trace`,
/// which ends at the boundary, or runs along it where the offset leads out) or, without faces, over tangent planes (`trace_line`); of twisted polygons the nearest point.
/// @throws InvalidArgument (no positions; another surface's center)
Vec3 center_position(const Surface& surface, const Center& center);

/// The source at a center; its axes are those of the frame of `center.vertex`.
Source source_at(const Center& center);

}  // namespace ahm
