// Exact maps compared with CGAL's exact distances and with maps by heat: cost, agreement, errors of vectors. Also locally
// shortest paths.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <optional>
#include <random>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 3, path_count = 100;
/// Above this number of vertices, CGAL's exact geodesics take minutes and gigabytes.
constexpr Index max_for_cgal = 15000;

/// Processor time of all threads.
template <class Work>
double cpu_seconds(const Work& work) {
  const std::clock_t before = std::clock();
  work();
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

struct HeatRow {
  double first = 0, additional = 0;
  std::vector<double> errors;
};

HeatRow with_heat(const Surface& surface, std::span<const Vertex> sources, std::span<const LogMap> exact) {
  HeatRow row;
  std::optional<LogMapSolver> solver;
  row.first = cpu_seconds([&] { solver.emplace(surface.graph()); });
  for (std::size_t s = 0; s < sources.size(); ++s) {
    std::optional<LogMap> map;
    row.additional = cpu_seconds([&] { map.emplace(solver->solve(Source::at_vertex(sources[s]))); });
    if (s == 0) row.first += row.additional;
    const std::vector<double> errors = vector_errors(surface, exact[s], *map);
    row.errors.insert(row.errors.end(), errors.begin(), errors.end());
  }
  return row;
}

struct CgalComparison {
  Cell seconds, difference;
};

CgalComparison cgal([[maybe_unused]] const Surface& surface, [[maybe_unused]] Vertex source,
                    [[maybe_unused]] const LogMap& exact) {
  CgalComparison cgal_result;
#ifdef AHM_METHODS_CGAL
  if (surface.size() > max_for_cgal) return cgal_result;
  std::vector<double> distance;
  cgal_result.seconds = cpu_seconds(
      [&] { distance = methods::exact_distance(surface.points(), surface.faces())->solve(source.index).distance; });
  double worst = 0, farthest = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (std::isnan(distance[i])) continue;
    farthest = std::max(farthest, distance[i]);
    worst = std::max(worst, std::abs(distance[i] - exact.distances()[i]));
  }
  cgal_result.difference = worst / farthest;
#endif
  return cgal_result;
}

/// Locally shortest paths between random vertices: milliseconds per path, and by which share they are longer than exact
/// ones.
struct Paths {
  double milliseconds = 0;
  std::vector<double> longer;
};

Paths fast_paths(const Surface& surface, const ExactGeodesics& geodesics, std::span<const Vertex> sources,
                 std::span<const LogMap> exact) {
  Paths paths;
  std::mt19937_64 random(1);
  const auto& triangles = geodesics.triangles().surface;
  for (int k = 0; k < path_count; ++k) {
    const std::size_t s = k % sources.size();
    const Vertex to(static_cast<Index>(random() % static_cast<unsigned>(surface.size())));
    if (exact[s].status(to) != Status::ok || !(exact[s].distance(to) > 0)) continue;
    double length = 0;
    paths.milliseconds += 1000 * cpu_seconds([&] {
                            length = exact::locally_shortest_path(triangles, triangles.vertex_point(sources[s]),
                                                                  triangles.vertex_point(to))
                                         .length;
                          });
    paths.longer.push_back(length * geodesics.triangles().length_unit / exact[s].distance(to) - 1);
  }
  paths.milliseconds /= static_cast<double>(paths.longer.size());
  return paths;
}

void measure(const Surface& surface, Table& table) {
  std::optional<ExactGeodesics> geodesics;
  const double layout = cpu_seconds([&] { geodesics.emplace(surface.mesh()); });
  std::vector<Vertex> sources;
  std::vector<LogMap> exact;
  double map_seconds = 0;
  for (int s = 0; s < source_count; ++s) {
    sources.emplace_back(surface.size() / 11 + s * (surface.size() / source_count));
    map_seconds += cpu_seconds([&] { exact.push_back(geodesics->log_map(sources.back())); }) / source_count;
  }
  const HeatRow heat = with_heat(surface, sources, exact);
  const CgalComparison cgal_result = cgal(surface, sources[0], exact[0]);
  const Paths paths = fast_paths(surface, *geodesics, sources, exact);
  table.add({surface.name(), surface.size(), layout, map_seconds, cgal_result.seconds, cgal_result.difference,
             heat.first, heat.additional, quantile(heat.errors, 0.5), mean(heat.errors), quantile(heat.errors, 0.95),
             quantile(heat.errors, 1), paths.milliseconds, quantile(paths.longer, 0.5), mean(paths.longer),
             quantile(paths.longer, 0.95), quantile(paths.longer, 1)});
}

}  // namespace

Table exact_compared(const Settings& settings) {
  Table table({"mesh", "vertices", "layout s", "exact map s", "CGAL s", "difference / diameter", "first heat map s",
               "additional heat map s", "vector median", "vector mean", "vector 95%", "vector max", "fast path ms",
               "fast path longer median", "fast path longer mean", "fast path longer 95%", "fast path longer max"});
  std::vector<Index> sizes{640};
  if (!settings.toy) sizes.insert(sizes.end(), {2560, 10000, 40000, 160000});
  for (Index n : sizes) measure(Surface("sphere", test::split_icosphere(n)), table);
  measure(Surface("torus", torus(settings.toy ? 640 : 10000)), table);
  for_user_surfaces(settings, 50000, [&](const Surface& surface) { measure(surface, table); });
  table.seen = fmt::format(
      "Exact maps take n^{:.2f} on all shapes, {:.2f} of the first map by heat (median). Vectors of heat are off by "
      "{:.3f} of the distance (median of the medians).",
      fitted_order(table.numbers("vertices"), table.numbers("exact map s")),
      quantile(table.numbers("exact map s"), 0.5) / quantile(table.numbers("first heat map s"), 0.5),
      quantile(table.numbers("vector median"), 0.5));
  return table;
}

}  // namespace ahm::bench
