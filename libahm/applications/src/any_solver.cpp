#include "ahm/applications/any_solver.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "ahm/maps/local_maps.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

LogMap AnySolver::map(Vertex source, double radius, bool frames) const {
  if (solver_ != nullptr)
    return solver_->solve(Source::at_vertex(source), {.radius = radius, .frames = frames, .spread = false});
  if (polar_ != nullptr) return polar_->log_map(source, {.radius = radius, .frames = frames});
  return geodesics_->log_map(source, {.radius = radius, .frames = frames, .progress = {}});
}

std::vector<double> AnySolver::coordinates(std::span<const Vertex> sources,
                                           std::span<const std::span<const Vertex>> regions,
                                           std::span<const double> reach) const {
  if (solver_ == nullptr) return coordinates_of_whole(sources, regions, reach);
  std::vector<Source> starts;
  for (Vertex vertex : sources) starts.push_back(Source::at_vertex(vertex));
  DiffusionOptions heat = solver_->options().diffusion();
  heat.check_graph = false;  // the solver's graph is checked
  std::vector<double> result = local_coordinates(solver_->graph(), starts, regions, heat);
  // Where heat decays to zero before it covers the region, the solver maps the whole surface, with the march where needed.
  auto first = result.begin();
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto end = first + 2 * std::ssize(regions[s]);
    if (!all_finite(std::span(first, end)))
      std::ranges::copy(coordinates_of_whole(sources.subspan(s, 1), regions.subspan(s, 1), reach.subspan(s, 1)), first);
    first = end;
  }
  return result;
}

std::vector<double> AnySolver::coordinates_of_whole(std::span<const Vertex> sources,
                                                    std::span<const std::span<const Vertex>> regions,
                                                    std::span<const double> reach) const {
  constexpr std::size_t block_size = 16;  // maps in memory at the same time
  std::vector<double> result;
  for (std::size_t first = 0; first < sources.size(); first += block_size) {
    const std::size_t count = std::min(block_size, sources.size() - first);
    std::vector<std::optional<LogMap>> maps(count);
    if (solver_ != nullptr) {
      std::vector<Source> starts;
      for (Vertex vertex : sources.subspan(first, count)) starts.push_back(Source::at_vertex(vertex));
      std::ranges::move(solver_->solve(starts, {.distances = false}), maps.begin());
    } else {
      detail::parallel_chunks(static_cast<Offset>(count), 1, threads_, [&](Offset k, Offset) {
        const std::size_t s = first + static_cast<std::size_t>(k);
        maps[k] = map(sources[s], reach[s]);
      });
    }
    for (std::size_t k = 0; k < count; ++k)
      for (Vertex vertex : regions[first + k]) {
        const auto phi = maps[k]->coordinates(vertex);
        result.insert(result.end(), phi.begin(), phi.end());
      }
  }
  return result;
}

double AnySolver::longest_corner_distance(const FaceList& faces) const {
  if (geodesics_ == nullptr) return std::numeric_limits<double>::infinity();
  double side = 0;
  const FlatTriangles& flat = geodesics_->triangles();
  for (exact::Half h = 0; h < 3 * flat.surface.face_count(); ++h) side = std::max(side, flat.surface.record(h).length);
  std::size_t corners = 3;
  for (std::size_t f = 0; f < faces.size(); ++f) corners = std::max(corners, faces[f].size());
  const std::size_t farthest = corners / 2;  // largest number of sides between two corners of a polygon
  return flat.length_unit * side * static_cast<double>(farthest);
}

VoronoiCells AnySolver::cells(std::span<const Vertex> sources) const {
  return geodesics_ == nullptr ? voronoi_cells(graph(), sources) : voronoi_cells(*geodesics_, sources);
}

}  // namespace ahm
