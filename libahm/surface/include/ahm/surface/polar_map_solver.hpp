/// \file
/// Log maps in geodesic polar coordinates: the length of the shortest path to each vertex times the direction in which it leaves
/// the source.
///
/// \code
/// const ahm::PolarMapSolver solver(surface);                 // a mesh, a cloud, a grid: nothing is factored
/// ahm::LogMap map = solver.log_map(ahm::Row{42});
/// ahm::RowLogMap rows = surface.on_rows(map);                // as of a map by heat
/// \endcode
#pragma once

#include <memory>
#include <optional>

#include "ahm/maps/polar_map.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

/// A surface prepared for polar maps: its one-rings and, where it has flat faces, its triangles. Immutable; all members may be
/// called from many threads at once. Refers to the surface, which has to stay where it is.
///
/// Around the source, exact windows give distances and directions; from there a front carries them on (`UnfoldingFront`), from the
/// source itself on surfaces without faces. The windows end after a number that takes about as long as the front.
class PolarMapSolver {
 public:
  /// @param threads  for the one-rings; 0: one per core
  explicit PolarMapSolver(const Surface& surface, unsigned threads = 0);
  explicit PolarMapSolver(Surface&&, unsigned = 0) = delete;

  const Surface& surface() const noexcept { return *surface_; }

  /// @param u_axis  as of `Surface::source`
  /// @throws InvalidArgument (as `Surface::source`, `polar_map`), ResourceExhausted, Cancelled
  LogMap log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis = {},
                 const PolarMapOptions& options = {}) const;

  double windows_per_vertex = 4;
  bool pin = true;

 private:
  const Surface* surface_;
  std::shared_ptr<const UnfoldingFront::Stars> stars_;
  std::optional<ExactGeodesics> geodesics_;  ///< none: the surface has no flat faces
};

}  // namespace ahm
