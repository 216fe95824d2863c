#include "commands/line_finder.hpp"

#include <mutex>
#include <utility>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/surface_lines.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::app {
namespace {

FoundLine over_faces(const ExactGeodesics& geodesics, exact::GeodesicPath path) {
  FoundLine line{path.status, {}, path.length, true, std::move(path.points)};
  for (const exact::MeshPoint& point : line.flat) line.points.push_back(geodesics.position(point));
  return line;
}

FoundLine over_planes(SurfaceLine found) {
  return {found.status, std::move(found.points), found.length, found.complete};
}

}  // namespace

LineFinder::LineFinder(const Surface& surface) : surface_(surface) {
  if (surface.faces().size() > 0) geodesics_.emplace(surface);
}

FoundLine LineFinder::path(const SurfacePoint& from, const SurfacePoint& to, bool fast) const {
  if (!geodesics_) return over_planes(shortest_line(surface_, from, to));
  return over_faces(*geodesics_,
                    fast ? geodesics_->locally_shortest_path(from, to) : geodesics_->path(std::array{from, to}));
}

std::vector<FoundLine> LineFinder::paths(std::span<const std::array<SurfacePoint, 2>> pairs, bool fast,
                                         const Progress& progress, unsigned threads) const {
  std::vector<FoundLine> result(pairs.size());
  if (geodesics_ && !fast) {
    std::vector<exact::GeodesicPath> found = geodesics_->paths(pairs, progress, threads);
    for (std::size_t k = 0; k < found.size(); ++k) result[k] = over_faces(*geodesics_, std::move(found[k]));
    return result;
  }
  std::mutex telling;
  std::size_t done = 0;
  detail::parallel_chunks(static_cast<Offset>(pairs.size()), 1, threads, [&](Offset k, Offset) {
    result[k] = path(pairs[k][0], pairs[k][1], fast);
    const std::lock_guard lock(telling);
    progress.step("paths", static_cast<double>(++done) / static_cast<double>(pairs.size()));
  });
  return result;
}

FoundLine LineFinder::trace(const SurfacePoint& from, const Vec3& direction, double length) const {
  if (!geodesics_) return over_planes(trace_line(surface_, from, direction, length));
  exact::TracedPath found = geodesics_->trace(from, direction, length);
  FoundLine line{Status::ok, {}, found.length, found.end == exact::TraceEnd::complete, std::move(found.points)};
  for (const exact::MeshPoint& point : line.flat) line.points.push_back(geodesics_->position(point));
  return line;
}

FoundLine LineFinder::tightened(std::span<const exact::MeshPoint> loop) const {
  return over_faces(*geodesics_, geodesics_->shortened(loop, true));
}

LogMap LineFinder::map(const SurfacePoint& point) const {
  if (geodesics_) return geodesics_->log_map(point);
  return LogMapSolver(surface_.graph()).solve(surface_.source(point).source);
}

}  // namespace ahm::app
