#include "ahm/surface/polar_map_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "flat_graph.hpp"

namespace ahm {
namespace {

/// At 8 windows per vertex the median map of real meshes is right to 0.02 of the distance at the 95th percentile (docs/concepts/accuracy.md). The
/// least number takes about 15 ms: up to some thousand vertices windows cover the surface.
constexpr Offset windows_per_vertex = 8, least_windows = Offset{1} << 17;

/// What a front over the triangles of a sheet has found, for a front over the graph. The triangles are as noisy as the points, so
/// that nothing there is exact. Expected errors are those of another front, which started at the source without windows, and the
/// difference to it over the root of 2, as of two estimates that are equally good.
std::vector<UnfoldingFront::Seed> found_by(const UnfoldingFront& front, const UnfoldingFront& other, bool frames) {
  std::vector<UnfoldingFront::Seed> seeds;
  for (Index i = 0; i < front.graph().size(); ++i) {
    const Vertex v(i);
    const double distance = front.distance(v);
    if (!std::isfinite(distance)) continue;
    const Vec2 direction = front.direction(v), other_direction = other.direction(v);
    const double share = other.distance(v) / distance;
    const double apart =
        std::hypot(direction[0] - share * other_direction[0], direction[1] - share * other_direction[1]);
    const double error = std::hypot(apart / std::numbers::sqrt2, other.direction_error(v));
    seeds.push_back({v, distance, direction, frames ? front.arrival(v) : Vec2{NAN, NAN}, front.nearest(v),
                     std::isfinite(error) ? error : 0});
  }
  return seeds;
}

}  // namespace

PolarMapSolver::PolarMapSolver(const TangentGraph& graph, const PolarSolverOptions& options) : graph_(&graph) {
  if (graph.dimension() != 2)
    throw InvalidArgument(
        "dimension_not_2",
        "a polar map needs a graph of dimension 2; this one has dimension " + std::to_string(graph.dimension()),
        "map it by heat");
  stars_ = UnfoldingFront::stars(graph, options.threads, false);
}

PolarMapSolver::PolarMapSolver(const Surface& surface, const PolarSolverOptions& options)
    : PolarMapSolver(surface.graph(), options) {
  surface_ = &surface;
  windows_ = options.windows.value_or(std::max(least_windows, windows_per_vertex * graph_->size()));
  if (windows_ <= 0) return;
  try {
    geodesics_.emplace(surface, surface.flat_approximation());
    if (!geodesics_->triangles().approximate) return;
    sheet_ = std::make_unique<const CsrGraph>(detail::flat_graph(geodesics_->triangles()));
    sheet_stars_ = UnfoldingFront::stars(*sheet_, options.threads, false);
  } catch (const InvalidArgument&) {  // no flat triangles
  } catch (const InvalidGeometry&) {  // a face without area
  }
}

/// @param seeds  seeds(options): exact polar coordinates around the source
template <class Seeds>
LogMap PolarMapSolver::seeded_map(const Source& source, const PolarMapOptions& options, const Seeds& seeds) const {
  return detail::with_memory_check("a polar map", [&] {
    UnfoldingFront front(*graph_, stars_, true);
    front.add(source);
    std::vector<UnfoldingFront::Seed> exact;
    try {
      exact = seeds(ExactMapOptions{
          .radius = options.radius, .most_windows = windows_, .frames = options.frames, .progress = options.progress});
    } catch (
        const InvalidGeometry&) {  // windows lost in needles, a source outside of the triangles: from the source, then
    }
    const auto run_from = [&](UnfoldingFront& over) {
      if (!exact.empty()) {
        // Where the front goes on it needs its focusing, and its orientation where that may differ.
        const double farthest = std::ranges::max_element(exact, {}, &UnfoldingFront::Seed::distance)->distance;
        const bool goes_on = exact.size() < static_cast<std::size_t>(graph_->size());
        if (goes_on || over.graph().transport_layout().may_reflect()) over.run(farthest, options.progress.stop);
        over.restart(exact);
      }
      over.run(options.radius, options.progress.stop);
    };
    if (sheet_ && !exact.empty()) {
      front.run(options.radius, options.progress.stop);
      UnfoldingFront over(*sheet_, sheet_stars_, true);
      over.add(source);
      run_from(over);
      exact = found_by(over, front, options.frames);
    }
    run_from(front);
    return polar_map(front, source, options);
  });
}

LogMap PolarMapSolver::log_map(const SurfacePoint& source, const std::optional<Vec3>& u_axis,
                               const PolarMapOptions& options) const {
  if (surface_ == nullptr) throw InvalidArgument("the solver is for a graph; a point of a surface needs its surface");
  return seeded_map(surface_->source(source, u_axis).source, options, [&](const ExactMapOptions& exact) {
    return geodesics_ ? geodesics_->seeds(source, u_axis, exact) : std::vector<UnfoldingFront::Seed>();
  });
}

LogMap PolarMapSolver::log_map(Vertex source, const PolarMapOptions& options) const {
  return seeded_map(Source::at_vertex(source), options, [&](const ExactMapOptions& exact) {
    return geodesics_ ? geodesics_->seeds(source, exact) : std::vector<UnfoldingFront::Seed>();
  });
}

LogMap PolarMapSolver::log_map(const Source& source, const PolarMapOptions& options) const {
  return seeded_map(source, options, [](const ExactMapOptions&) { return std::vector<UnfoldingFront::Seed>(); });
}

Method choose_method(const TangentGraph& graph) { return graph.is_delaunay() ? Method::polar : Method::heat; }

}  // namespace ahm
