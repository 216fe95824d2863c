#include "ahm/surface/surface_solver.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <span>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm {
namespace {

/// The options of a method in place of automatic ones.
MethodOptions chosen(const Surface& surface, const MethodOptions& options) {
  const auto* automatic = std::get_if<AutomaticOptions>(&options);
  if (automatic == nullptr) return options;
  if (surface.suggested_method() == Method::polar) return PolarSolverOptions{.threads = automatic->threads};
  return HeatOptions{
      .expected_maps = automatic->expected_maps, .threads = automatic->threads, .progress = automatic->progress};
}

/// Distances by row: the least of the vertices of each row.
template <class Distance>
std::vector<double> by_row(const RowMap& rows, const Distance& distance) {
  std::vector<double> result(static_cast<std::size_t>(rows.row_count()), NAN);
  for (Index r = 0; r < rows.row_count(); ++r)
    if (const auto vertex = rows.least(Row(r), distance)) result[static_cast<std::size_t>(r)] = distance(*vertex);
  return result;
}

void check_radius(double radius) {
  if (!(radius > 0)) throw InvalidArgument("radius: " + std::to_string(radius) + "; choose a number > 0");
}

}  // namespace

Row Location::checked_row(bool in_range, Index row) {
  if (!in_range) throw InvalidArgument("row_out_of_range", "row: larger than any index", "count rows from 0");
  return Row(row);
}

SurfacePoint Location::on(const Surface& surface) const {
  if (const auto* position = std::get_if<Vec3>(&place_)) return surface.closest_point(*position).point;
  return std::get<SurfacePoint>(place_);
}

struct SurfaceSolver::Impl {
  Impl(std::shared_ptr<const Surface> shared, const MethodOptions& options) : surface(std::move(shared)) {
    const MethodOptions wanted = chosen(*surface, options);
    if (const auto* o = std::get_if<HeatOptions>(&wanted)) {
      method = Method::heat;
      threads = o->threads;
      heat.emplace(surface->graph(), *o);
    } else if (const auto* o = std::get_if<ExactSolverOptions>(&wanted)) {
      method = Method::exact;
      threads = o->threads;
      geodesics();
    } else {
      const auto& polar_options = std::get<PolarSolverOptions>(wanted);
      threads = polar_options.threads;
      polar.emplace(*surface, polar_options);
    }
  }

  /// The flat faces, laid out when they are first needed.
  const ExactGeodesics& geodesics() const {
    std::call_once(once, [&] { exact.emplace(*surface); });
    return *exact;
  }

  LogMap one_map(const SurfacePoint& point, const SurfaceSource& source, const SurfaceMapOptions& o) const {
    if (heat) return heat->solve(source.source, heat_options(o));
    if (polar) return polar->log_map(point, o.u_axis, {.radius = o.radius, .frames = o.frames, .progress = o.progress});
    return geodesics().log_map(point, o.u_axis, {.radius = o.radius, .frames = o.frames, .progress = o.progress});
  }

  static MapOptions heat_options(const SurfaceMapOptions& o) {
    MapOptions result{.radius = o.radius, .frames = o.frames};
    if (o.progress.report || o.progress.stop.stop_possible()) result.progress = o.progress;
    return result;
  }

  /// The options with a method. Inside small radii polar maps are exact.
  LocalMapOptions local_options(LocalMapOptions o) const {
    if (!o.method) o.method = method == Method::heat ? Method::heat : Method::polar;
    return o;
  }

  SurfaceLogMap with_rows(SurfaceSource source, LogMap map, unsigned map_threads) const {
    RowLogMap rows = surface->to_rows(map, map_threads);
    return {std::move(rows), std::move(source), std::move(map)};
  }

  std::shared_ptr<const Surface> surface;
  Method method = Method::polar;
  unsigned threads = 0;
  std::optional<LogMapSolver> heat;
  std::optional<PolarMapSolver> polar;
  mutable std::once_flag once;
  mutable std::optional<ExactGeodesics> exact;
};

SurfaceSolver::SurfaceSolver(const Surface& surface, const MethodOptions& options)
    : SurfaceSolver(std::shared_ptr<const Surface>(std::shared_ptr<const Surface>(), &surface), options) {}

SurfaceSolver::SurfaceSolver(std::shared_ptr<const Surface> surface, const MethodOptions& options)
    : impl_(std::make_unique<const Impl>(std::move(surface), options)) {}

SurfaceSolver::~SurfaceSolver() = default;
SurfaceSolver::SurfaceSolver(SurfaceSolver&&) noexcept = default;
SurfaceSolver& SurfaceSolver::operator=(SurfaceSolver&&) noexcept = default;

const Surface& SurfaceSolver::surface() const noexcept { return *impl_->surface; }
Method SurfaceSolver::method() const noexcept { return impl_->method; }

SurfaceLogMap SurfaceSolver::log_map(const Location& source, const SurfaceMapOptions& options) const {
  const SurfacePoint point = source.on(surface());
  SurfaceSource from = surface().source(point, options.u_axis);
  LogMap map = impl_->one_map(point, from, options);
  return impl_->with_rows(std::move(from), std::move(map), impl_->threads);
}

std::vector<SurfaceLogMap> SurfaceSolver::log_maps(const std::vector<Location>& sources,
                                                   const SurfaceMapOptions& options) const {
  std::vector<SurfacePoint> points;
  std::vector<SurfaceSource> from;
  for (const Location& source : sources) {
    points.push_back(source.on(surface()));
    from.push_back(surface().source(points.back(), options.u_axis));
  }
  std::vector<std::optional<LogMap>> maps(sources.size());
  if (impl_->heat) {
    std::vector<Source> plain;
    for (const SurfaceSource& one : from) plain.push_back(one.source);
    std::vector<LogMap> solved = impl_->heat->solve(plain, Impl::heat_options(options));
    for (std::size_t k = 0; k < maps.size(); ++k) maps[k] = std::move(solved[k]);
  } else {
    SurfaceMapOptions one = options;
    one.progress.report = {};  // progress of all maps, not of each
    std::atomic<std::size_t> done = 0;
    detail::parallel_chunks(static_cast<Offset>(maps.size()), 1, impl_->threads, [&](Offset k, Offset) {
      maps[static_cast<std::size_t>(k)] =
          impl_->one_map(points[static_cast<std::size_t>(k)], from[static_cast<std::size_t>(k)], one);
      options.progress.step("maps", static_cast<double>(++done) / static_cast<double>(maps.size()));
    });
  }
  std::vector<SurfaceLogMap> result;
  for (std::size_t k = 0; k < maps.size(); ++k)
    result.push_back(impl_->with_rows(std::move(from[k]), std::move(*maps[k]), impl_->threads));
  return result;
}

std::vector<double> SurfaceSolver::quality(const SurfaceLogMap& map) const {
  return to_rows(map, map_quality(surface().graph(), map.vertices, impl_->threads));
}

Sample SurfaceSolver::at(const SurfaceLogMap& map, const Location& place) const {
  return surface().at(map.vertices, place.on(surface()));
}

std::vector<double> SurfaceSolver::distance(const Location& source, const SurfaceDistanceOptions& options) const {
  return distance(std::vector<Location>{source}, options);
}

std::vector<double> SurfaceSolver::distance(const std::vector<Location>& sources,
                                            const SurfaceDistanceOptions& options) const {
  if (impl_->method != Method::exact) return ahm::distance(surface(), sources, options);
  check_radius(options.radius);
  std::vector<ExactSource> from;
  for (const Location& source : sources) from.push_back({.point = source.on(surface())});
  const LogMap map = impl_->geodesics().log_map(from, {.radius = options.radius, .progress = options.progress}).map;
  return by_row(surface().rows(), [&](Vertex v) { return map.distance(v); });
}

SurfacePath SurfaceSolver::path(const Location& start, const Location& end) const {
  const std::array<SurfacePoint, 2> ends{start.on(surface()), end.on(surface())};
  if (surface().faces().size() == 0) return shortest_line(surface(), ends[0], ends[1]);
  const ExactGeodesics& geodesics = impl_->geodesics();
  const exact::GeodesicPath path = geodesics.path(ends);
  SurfacePath result{.status = path.status, .points = {}, .length = path.length};
  for (const exact::MeshPoint& point : path.points) result.points.push_back(geodesics.position(point));
  return result;
}

SurfacePath SurfaceSolver::trace(const Location& start, const Vec3& direction, double length) const {
  const SurfacePoint from = start.on(surface());
  if (surface().faces().size() == 0) return trace_line(surface(), from, direction, length);
  const ExactGeodesics& geodesics = impl_->geodesics();
  const exact::TracedPath path = geodesics.trace(from, direction, length);
  SurfacePath result{.points = {}, .length = path.length, .complete = path.end == exact::TraceEnd::complete};
  for (const exact::MeshPoint& point : path.points) result.points.push_back(geodesics.position(point));
  return result;
}

RowLocalMaps SurfaceSolver::local_maps(const LocalMapOptions& options) const {
  const LocalMapOptions own = impl_->local_options(options);
  return impl_->polar && own.method == Method::polar ? row_local_maps(*impl_->polar, own)
                                                     : row_local_maps(surface(), own);
}

RowLocalMaps SurfaceSolver::local_maps(const std::vector<Location>& sources, const LocalMapOptions& options) const {
  const LocalMapOptions own = impl_->local_options(options);
  std::vector<SurfacePoint> from;
  from.reserve(sources.size());
  for (const Location& source : sources) from.push_back(source.on(surface()));
  return impl_->polar && own.method == Method::polar ? row_local_maps(*impl_->polar, from, own)
                                                     : row_local_maps(surface(), from, own);
}

std::vector<double> distance(const Surface& surface, const std::vector<Location>& sources,
                             const SurfaceDistanceOptions& options) {
  check_radius(options.radius);
  const TangentGraph& graph = surface.graph();
  Wavefront front(graph, Wavefront::one_rings_within(graph, options.radius, 0));
  for (const Location& source : sources) front.add(surface.source(source.on(surface)).source);
  options.progress.step("distance", 0);
  front.run(options.radius, options.progress.stop);
  return by_row(surface.rows(), [&](Vertex v) {
    const double found = front.distance(v);
    return std::isfinite(found) && found <= options.radius ? found : NAN;
  });
}

SurfaceLogMap log_map(const Surface& surface, const Location& source, const SurfaceMapOptions& options,
                      const MethodOptions& method) {
  return SurfaceSolver(surface, method).log_map(source, options);
}

}  // namespace ahm
