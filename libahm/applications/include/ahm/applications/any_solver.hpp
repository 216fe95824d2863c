/// \file
/// The solver that computes the log maps of an application: heat method, polar maps or exact geodesics.
///
/// \code
/// ahm::Atlas by_heat = ahm::make_atlas(solver, sources, faces);             // ahm::LogMapSolver
/// ahm::Atlas polar = ahm::make_atlas(polar_solver, sources, faces);         // ahm::PolarMapSolver
/// ahm::Atlas exact = ahm::make_atlas(geodesics, sources, faces);            // ahm::ExactGeodesics
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/applications/cells.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"

namespace ahm {

/// A reference to one of the three solvers, which must outlive it.
class AnySolver {
 public:
  AnySolver(const LogMapSolver& solver) : solver_(&solver) {}
  /// @param threads  number of threads for several maps; 0: one per core
  AnySolver(const PolarMapSolver& solver, unsigned threads = 0) : polar_(&solver), threads_(threads) {}
  AnySolver(const ExactGeodesics& geodesics, unsigned threads = 0) : geodesics_(&geodesics), threads_(threads) {}

  Method method() const noexcept {
    return solver_ != nullptr ? Method::heat : polar_ != nullptr ? Method::polar : Method::exact;
  }
  const TangentGraph& graph() const {
    return solver_ != nullptr ? solver_->graph() : polar_ != nullptr ? polar_->graph() : geodesics_->surface().graph();
  }

  /// The log map from a vertex, in the axes of its frame. @throws as `LogMapSolver::solve`, or `log_map` of the other
  /// solvers
  LogMap map(Vertex source, double radius, bool frames = false) const;
  /// Coordinates of the vertices of regions[s] in the map from sources[s]: two numbers per vertex, region by region; NaN
  /// where the map has none. The heat method uses `local_coordinates`, which does not need the factorizations of the
  /// solver.
  /// @param reach  radius of each polar or exact map, world units; at least the distance of the farthest vertex of its
  /// region. The heat method ignores it
  /// @throws as `map`, `local_coordinates`
  std::vector<double> coordinates(std::span<const Vertex> sources, std::span<const std::span<const Vertex>> regions,
                                  std::span<const double> reach) const;
  /// Upper bound of the distance between two corners of a face along its sides, world units. Infinite for heat and polar
  /// maps, which need no bound.
  double longest_corner_distance(const FaceList& faces) const;
  /// Geodesic Voronoi cells of the sources. @throws as `voronoi_cells`
  VoronoiCells cells(std::span<const Vertex> sources) const;

 private:
  /// Coordinates as in `coordinates`, from maps of the whole surface, a block of sources at a time.
  std::vector<double> coordinates_of_whole(std::span<const Vertex> sources,
                                           std::span<const std::span<const Vertex>> regions,
                                           std::span<const double> reach) const;

  const LogMapSolver* solver_ = nullptr;
  const PolarMapSolver* polar_ = nullptr;
  const ExactGeodesics* geodesics_ = nullptr;
  unsigned threads_ = 0;
};

}  // namespace ahm
