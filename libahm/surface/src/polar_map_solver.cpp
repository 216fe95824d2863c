#include "ahm/surface/polar_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ahm/error.hpp"

namespace ahm {

PolarMapSolver::PolarMapSolver(const Surface& surface, unsigned threads)
    : surface_(&surface), stars_(UnfoldingFront::stars(surface.graph(), threads, false)) {
  if (surface.faces().size() == 0) return;
  geodesics_.emplace(surface);
}

LogMap PolarMapSolver::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const PolarMapOptions& options) const {
  const PlacedSource placed = surface_->source(source, u_axis);
  UnfoldingFront front(surface_->graph(), stars_, true);
  front.add(placed.source);
  if (geodesics_ && windows_per_vertex > 0) {
    const auto budget = static_cast<Offset>(windows_per_vertex * surface_->graph().size());
    const LogMap exact = geodesics_->log_map(
        source, u_axis, {.radius = options.radius, .most_windows = budget, .progress = options.progress});
    std::vector<UnfoldingFront::Seed> seeds;
    double farthest = 0;
    for (Index i = 0; i < exact.size(); ++i) {
      if (exact.status(Vertex(i)) != Status::ok) continue;
      const double d = exact.distance(Vertex(i));
      const auto phi = exact.coordinates(Vertex(i));
      const double r = std::hypot(phi[0], phi[1]);
      farthest = std::max(farthest, d);
      seeds.push_back({Vertex(i), d, {phi[0] / r, phi[1] / r}});
    }
    front.run(farthest);
    if (pin) front.restart(seeds);
  }
  front.run(options.radius);
  return polar_map(front, placed.source, options);
}

}  // namespace ahm
