#include "cells.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "ahm/applications/cells.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

void check_vertices(const TangentGraph& graph, std::span<const Vertex> vertices) {
  if (vertices.empty()) throw InvalidArgument("'vertices' is empty");
  std::vector<bool> is_taken(static_cast<std::size_t>(graph.size()), false);
  for (const auto [vertex] : vertices) {
    if (vertex < 0 || vertex >= graph.size())
      throw InvalidArgument("vertex " + std::to_string(vertex) + " is outside [0, " + std::to_string(graph.size()) +
                            ")");
    if (is_taken[vertex]) throw InvalidArgument("vertex " + std::to_string(vertex) + " occurs twice in 'vertices'");
    is_taken[vertex] = true;
  }
}

/// The candidates in ascending order: the vertices of `among`, or all.
std::vector<Vertex> candidates(Index vertices, Vertex first, Index count, std::span<const Vertex> among) {
  if (first.index < 0 || first.index >= vertices)
    throw InvalidArgument("'first' " + std::to_string(first.index) + " is outside [0, " + std::to_string(vertices) +
                          ")");
  std::vector<Vertex> result(among.begin(), among.end());
  for (Index i = 0; among.empty() && i < vertices; ++i) result.emplace_back(i);
  std::sort(result.begin(), result.end());
  if (result.front().index < 0 || result.back().index >= vertices)
    throw InvalidArgument("a vertex of 'among' is outside [0, " + std::to_string(vertices) + ")");
  if (count < 1 || count > std::ssize(result))
    throw InvalidArgument("'count' " + std::to_string(count) + " must be in [1, " + std::to_string(result.size()) +
                          "]");
  return result;
}

}  // namespace

VoronoiCells voronoi_cells(const TangentGraph& graph, std::span<const Vertex> vertices) {
  return detail::with_memory_check("computing Voronoi cells", [&] {
    Wavefront front(graph, Wavefront::one_rings(graph, 0));
    return voronoi_cells(front, vertices);
  });
}

VoronoiCells voronoi_cells(Wavefront& front, std::span<const Vertex> vertices) {
  return detail::with_memory_check("computing Voronoi cells", [&] {
    const TangentGraph& graph = front.graph();
    check_vertices(graph, vertices);
    if (front.points() > std::ssize(vertices))
      throw InvalidArgument("'front' has " + detail::counted(front.points(), "point") + ", more than 'vertices' (" +
                            std::to_string(vertices.size()) + ")");
    for (Vertex vertex : vertices.subspan(static_cast<std::size_t>(front.points())))
      front.add(Source::at_vertex(vertex));
    front.run();
    std::vector<std::optional<Frame>> starts;
    for (const auto [vertex] : vertices) starts.push_back(graph.frame(vertex));
    VoronoiCells cells;
    for (Index i = 0; i < graph.size(); ++i) {
      const Index label = cells.labels.emplace_back(front.nearest(Vertex(i)));
      if (label < 0) {
        cells.distances.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const auto start = starts[label], here = start ? graph.frame(i) : std::nullopt;
      const double line = here ? distance(start->origin, here->origin) : 0;
      cells.distances.push_back(bounded_distance(line, front.distance(Vertex(i))));
    }
    return cells;
  });
}

VoronoiCells voronoi_cells(const ExactGeodesics& geodesics, std::span<const Vertex> vertices,
                           const ExactMapOptions& options) {
  check_vertices(geodesics.surface().graph(), vertices);
  return detail::with_memory_check("computing Voronoi cells", [&] {
    const exact::PolyhedralSurface& triangles = geodesics.triangles().surface;
    std::vector<exact::MeshPoint> sources;
    for (Vertex vertex : vertices) sources.push_back(triangles.vertex_point(vertex));
    const double unit = geodesics.triangles().length_unit;
    const exact::ExactMap map = exact::exact_map(
        triangles, sources, {.radius = options.radius / unit, .targets = {}, .progress = options.progress});
    VoronoiCells cells;
    for (Index i = 0; i < map.size(); ++i) {
      cells.labels.push_back(map.source(Vertex(i)));
      cells.distances.push_back(unit * map.distance(Vertex(i)));
    }
    return cells;
  });
}

std::vector<Vertex> farthest_points(const TangentGraph& graph, Vertex first, Index count, const Progress& progress,
                                    std::span<const Vertex> among) {
  return detail::with_memory_check("choosing farthest points", [&] {
    Wavefront front(graph, Wavefront::one_rings(graph, 0));
    return farthest_points(front, first, count, progress, among);
  });
}

std::vector<Vertex> farthest_points(Wavefront& front, Vertex first, Index count, const Progress& progress,
                                    std::span<const Vertex> among) {
  return detail::with_memory_check("choosing farthest points", [&] {
    if (front.points() > 0)
      throw InvalidArgument("'front' already has points (" + std::to_string(front.points()) + "); use a new front");
    FarthestQueue farthest(candidates(front.graph().size(), first, count, among));
    std::vector<Vertex> points{first};
    while (points.size() < static_cast<std::size_t>(count)) {
      progress.step("farthest points", static_cast<double>(points.size()) / count);
      front.add(Source::at_vertex(points.back()));
      front.run();
      points.push_back(farthest.of([&](Vertex vertex) { return front.distance(vertex); }));
    }
    return points;
  });
}

std::vector<Vertex> farthest_points(const ExactGeodesics& geodesics, Vertex first, Index count,
                                    const ExactMapOptions& options, std::span<const Vertex> among) {
  const exact::PolyhedralSurface& triangles = geodesics.triangles().surface;
  return detail::with_memory_check("choosing farthest points", [&] {
    FarthestQueue farthest(candidates(triangles.vertex_count(), first, count, among));
    std::vector<Vertex> points{first};
    std::vector<double> distance(static_cast<std::size_t>(triangles.vertex_count()),
                                 std::numeric_limits<double>::infinity());
    exact::ExactOptions nearer;
    nearer.progress.stop = options.progress.stop;
    while (points.size() < static_cast<std::size_t>(count)) {
      options.progress.step("farthest points", static_cast<double>(points.size()) / count);
      const exact::ExactMap map = exact::exact_map(triangles, triangles.vertex_point(points.back()), nearer);
      for (Index i = 0; i < map.size(); ++i)
        if (const double d = map.distance(Vertex(i)); d < distance[i]) distance[i] = d;  // false for NaN
      points.push_back(farthest.of([&](Vertex vertex) { return distance[vertex.index]; }));
      nearer.radius = distance[points.back().index];  // no vertex farther than this gets nearer
    }
    return points;
  });
}

}  // namespace ahm
