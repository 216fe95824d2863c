#include "ahm/applications/map_maker.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "ahm/util/parallel.hpp"

namespace ahm {

LogMap MapMaker::map(Vertex source, double radius) const {
  if (solver_ != nullptr) return solver_->solve(Source::at_vertex(source), {.radius = radius, .spread = false});
  return geodesics_->log_map(source, {.radius = radius, .frames = false, .progress = {}});
}

std::vector<LogMap> MapMaker::maps(std::span<const Vertex> sources, std::span<const double> reach) const {
  if (solver_ != nullptr) {
    std::vector<Source> starts;
    for (Vertex vertex : sources) starts.push_back(Source::at_vertex(vertex));
    return solver_->solve(starts, {.spread = false});
  }
  std::vector<std::optional<LogMap>> made(sources.size());
  detail::parallel_chunks(static_cast<Offset>(sources.size()), 1, threads_, [&](Offset k, Offset) {
    made[k] = geodesics_->log_map(sources[k], {.radius = reach[k], .frames = false, .progress = {}});
  });
  std::vector<LogMap> result;
  for (auto& map : made) result.push_back(std::move(*map));
  return result;
}

double MapMaker::longest_way(const FaceList& faces) const {
  if (solver_ != nullptr) return std::numeric_limits<double>::infinity();
  double side = 0;
  const FlatTriangles& flat = geodesics_->triangles();
  for (exact::Half h = 0; h < 3 * flat.surface.face_count(); ++h) side = std::max(side, flat.surface.record(h).length);
  std::size_t corners = 3;
  for (std::size_t f = 0; f < faces.size(); ++f) corners = std::max(corners, faces[f].size());
  return flat.length_unit * side * static_cast<double>(corners / 2);
}

VoronoiCells MapMaker::cells(std::span<const Vertex> sources) const {
  return solver_ != nullptr ? voronoi_cells(solver_->graph(), sources) : voronoi_cells(*geodesics_, sources);
}

}  // namespace ahm
