#include "commands/line_finder.hpp"

#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/util/parallel.hpp"
#include "cli/source_list.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

namespace ahm::app {
namespace {

FoundLine over_faces(const ExactGeodesics& geodesics, exact::GeodesicPath path) {
  FoundLine line{path.status, {}, path.length, true, std::move(path.points)};
  for (const exact::MeshPoint& point : line.flat) line.points.push_back(geodesics.position(point));
  return line;
}

FoundLine over_planes(SurfacePath found) {
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
  std::mutex progress_mutex;
  std::size_t done = 0;
  detail::parallel_chunks(static_cast<Offset>(pairs.size()), 1, threads, [&](Offset k, Offset) {
    result[k] = path(pairs[k][0], pairs[k][1], fast);
    const std::lock_guard lock(progress_mutex);
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

namespace {

void write_view(const LineFinder& finder, const Input& input, const InputOptions& options, const OutputOptions& output,
                const Polylines& curves, Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, options);
  RowLogMap rows;
  render::Scene scene = results.scene();
  render::PictureOptions picture;
  picture.pattern = render::Pattern::none;
  if (curves.from) {
    rows = input.surface().to_rows(finder.map(*curves.from));
    scene = results.scene(rows, {}, input.surface().source(*curves.from));
    scene.source_axes.reset();
    picture.pattern = render::Pattern::polar;
  }
  std::vector<Index> pieces;
  for (Index b : curves.begin)
    if (b > (pieces.empty() ? 0 : pieces.back()) && b < std::ssize(curves.points)) pieces.push_back(b);
  scene.curve = curves.points;
  scene.curve_pieces = pieces;
  if (!curves.from && !curves.points.empty()) scene.source = curves.points.front();
  results.write_view(scene, journal, picture);
}

}  // namespace

void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolylines& find) {
  check_results(options.path, output, {".csv", ".jsonl", ".ply", ".vtp", ".obj"});
  Journal journal(output.verbosity);
  const Input input = open_input(options, journal, source);
  journal.start(name);
  const LineFinder finder(input.surface());
  const Polylines curves = find(finder, input, journal);
  write_view(finder, input, options, output, curves, journal);
  journal.start("write");
  write_polylines(output.output, output.format, curves);
  nlohmann::ordered_json j = summary("ahm " + name, options.path, output, input);
  j.update(curves.json);
  deliver(std::move(j), curves.text, output, journal);
}

SurfacePoint point_on_surface(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_of(input, spec, option);
  if (const auto* position = std::get_if<SourcePosition>(&spec))
    return input.surface().closest_point(position->position).point;
  place(input, spec, std::nullopt, option);  // checks the row or face
  return point_of(input, spec);
}

Vec3 vector_of(const Direction& direction, const Input& input, const SurfacePoint& point, const std::string& option) {
  const auto* angle = std::get_if<double>(&direction);
  if (angle == nullptr) return std::get<Vec3>(direction);
  try {
    return input.surface().direction(point, *angle);
  } catch (const InvalidArgument& e) {
    throw InvalidArgument(option + ": " + e.what());
  }
}

}  // namespace ahm::app
