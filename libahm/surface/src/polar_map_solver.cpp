#include "ahm/surface/polar_map_solver.hpp"

#include <algorithm>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"

namespace ahm {
namespace {

/// At 8 windows per vertex the median map of real meshes is right to 0.02 of the distance at the 95th percentile (docs/accuracy.md). The
/// least number takes about 15 ms: up to some thousand vertices windows cover the surface.
constexpr Offset windows_per_vertex = 8, least_windows = Offset{1} << 17;

}  // namespace

PolarMapSolver::PolarMapSolver(const Surface& surface, const PolarSolverOptions& options)
    : surface_(&surface),
      stars_(UnfoldingFront::stars(surface.graph(), options.threads, false)),
      windows_(options.windows.value_or(std::max(least_windows, windows_per_vertex * surface.graph().size()))) {
  if (windows_ <= 0 || surface.faces().size() == 0) return;
  try {
    geodesics_.emplace(surface);
  } catch (const InvalidArgument&) {  // no flat triangles
  } catch (const InvalidGeometry&) {  // a face without area
  }
}

/// @param seeds  seeds(geodesics, options): exact polar coordinates around the source
template <class Seeds>
LogMap PolarMapSolver::log_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const {
  const TangentGraph& graph = surface_->graph();
  UnfoldingFront front(graph, stars_, true);
  front.add(source);
  if (geodesics_) {
    std::vector<UnfoldingFront::Seed> exact;
    try {
      exact = seeds(*geodesics_, ExactMapOptions{.radius = options.radius,
                                                 .most_windows = windows_,
                                                 .frames = options.frames,
                                                 .progress = options.progress});
    } catch (const InvalidGeometry&) {  // windows got lost in needles: from the source, then
    }
    double farthest = 0;
    for (const UnfoldingFront::Seed& seed : exact) farthest = std::max(farthest, seed.distance);
    // Where the front goes on it needs its focusing; and orientation where that is not the same everywhere.
    const bool goes_on = exact.size() < static_cast<std::size_t>(graph.size());
    if (goes_on || graph.transport_layout().may_reflect()) front.run(farthest, options.progress.stop);
    if (!exact.empty()) front.restart(exact);
  }
  front.run(options.radius, options.progress.stop);
  return polar_map(front, source, options);
}

LogMap PolarMapSolver::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const PolarMapOptions& options) const {
  const auto seeds = [&](const ExactGeodesics& geodesics, const ExactMapOptions& exact) {
    return geodesics.seeds(source, u_axis, exact);
  };
  return detail::with_memory_check("a polar map",
                                   [&] { return log_map(surface_->source(source, u_axis).source, options, seeds); });
}

LogMap PolarMapSolver::log_map(Vertex source, const PolarMapOptions& options) const {
  const auto seeds = [&](const ExactGeodesics& geodesics, const ExactMapOptions& exact) {
    return geodesics.seeds(source, exact);
  };
  return detail::with_memory_check("a polar map",
                                   [&] { return log_map(Source::at_vertex(source), options, seeds); });
}

}  // namespace ahm
