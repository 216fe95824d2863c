/// \file
/// Who makes the log maps of an application: diffusion, or exact geodesics.
///
/// \code
/// ahm::Atlas by_heat = ahm::make_atlas(solver, sources, faces);             // ahm::LogMapSolver
/// ahm::Atlas exact = ahm::make_atlas(geodesics, sources, faces);            // ahm::ExactGeodesics
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/applications/cells.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm {

/// Either of the two, which has to outlive it.
class MapMaker {
 public:
  MapMaker(const LogMapSolver& solver) : solver_(&solver) {}
  /// @param threads  0: one per core
  MapMaker(const ExactGeodesics& geodesics, unsigned threads = 0) : geodesics_(&geodesics), threads_(threads) {}

  Method method() const noexcept { return solver_ != nullptr ? Method::heat : Method::exact; }
  const TangentGraph& graph() const { return solver_ != nullptr ? solver_->graph() : geodesics_->surface().graph(); }

  /// The map from a vertex in the axes of its frame. @throws as `LogMapSolver::solve`, `ExactGeodesics::log_map`
  LogMap map(Vertex source, double radius) const;
  /// Maps that need not know more than the surroundings of their sources: exact ones end there.
  /// @param reach  one per source, world units
  std::vector<LogMap> maps(std::span<const Vertex> sources, std::span<const double> reach) const;
  /// No corners of a face are farther apart along its sides; of heat, which needs no bound, infinite. World units.
  double longest_way(const FaceList& faces) const;
  /// @throws as `voronoi_cells`
  VoronoiCells cells(std::span<const Vertex> sources) const;

 private:
  const LogMapSolver* solver_ = nullptr;
  const ExactGeodesics* geodesics_ = nullptr;
  unsigned threads_ = 0;
};

}  // namespace ahm
