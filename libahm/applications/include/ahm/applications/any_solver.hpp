/// \file
/// What makes the log maps of an application: diffusion, a front in polar coordinates, or exact geodesics.
///
/// \code
/// ahm::Atlas by_heat = ahm::make_atlas(solver, sources, faces);             // ahm::LogMapSolver
/// ahm::Atlas polar = ahm::make_atlas(polar_solver, sources, faces);         // ahm::PolarMapSolver
/// ahm::Atlas exact = ahm::make_atlas(geodesics, sources, faces);            // ahm::ExactGeodesics
/// ahm::Atlas within = ahm::make_atlas({geodesics, {.tolerance = 1e-3}}, sources, faces);
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/applications/cells.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"

namespace ahm {

/// One of the three, which has to outlive it.
class AnySolver {
 public:
  AnySolver(const LogMapSolver& solver) : solver_(&solver) {}
  /// @param threads  of what makes several maps; 0: one per core
  AnySolver(const PolarMapSolver& solver, unsigned threads = 0) : polar_(&solver), threads_(threads) {}
  /// @param options  tolerance and threads; of every map its own radius, and frames
  AnySolver(const ExactGeodesics& geodesics, const ExactMapOptions& options = {})
      : geodesics_(&geodesics), tolerance_(options.tolerance), threads_(options.threads) {}

  Method method() const noexcept {
    return solver_ != nullptr ? Method::heat : polar_ != nullptr ? Method::polar : Method::exact;
  }
  const TangentGraph& graph() const {
    return solver_ != nullptr ? solver_->graph() : polar_ != nullptr ? polar_->graph() : geodesics_->surface().graph();
  }

  /// The map from a vertex in the axes of its frame. @throws as `LogMapSolver::solve`, `log_map` of the others
  LogMap map(Vertex source, double radius, bool frames = false) const;
  /// The coordinates of the vertices of regions[s] in the map from sources[s], two numbers each, region by region; NaN where it has
  /// none. By heat as `local_coordinates`, for which the solver need not have factored anything.
  /// @param reach  of every source, no nearer than the farthest of its vertices is; maps by other methods end there. World units
  /// @throws as `map`, `local_coordinates`
  std::vector<double> coordinates(std::span<const Vertex> sources, std::span<const std::span<const Vertex>> regions,
                                  std::span<const double> reach) const;
  /// No corners of a face are farther apart along its sides; of heat and polar maps, which need no bound, infinite. World units.
  double longest_corner_distance(const FaceList& faces) const;
  /// @throws as `voronoi_cells`
  VoronoiCells cells(std::span<const Vertex> sources) const;

 private:
  /// Those of whole maps, a block of sources at a time.
  std::vector<double> coordinates_of_whole(std::span<const Vertex> sources,
                                           std::span<const std::span<const Vertex>> regions,
                                           std::span<const double> reach) const;

  const LogMapSolver* solver_ = nullptr;
  const PolarMapSolver* polar_ = nullptr;
  const ExactGeodesics* geodesics_ = nullptr;
  double tolerance_ = 0;
  unsigned threads_ = 0;
};

}  // namespace ahm
