// Local maps of every vertex, and the margin that they need.
#include "ahm/maps/local_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"

namespace ahm::bench {
namespace {

/// Largest differences between local maps and maps of the whole graph, relative to the radius, over some sources.
struct Difference {
  double coordinates = 0, distances = 0;
};

Difference difference(const TangentGraph& graph, double radius, double margin, Variant variant) {
  const LogMapSolver solver(graph, {.strategy = Strategy::global});
  std::vector<Vertex> sources;
  for (Index s = 0; s < graph.size(); s += graph.size() / 40) sources.emplace_back(s);
  const LocalMaps maps =
      ahm::local_maps(graph, sources, {.radius = radius, .margin = margin, .heat = {.variant = variant}});
  Difference worst;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const LogMap whole = solver.solve(Source::at_vertex(sources[s]), {.variant = variant});
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) {
      const Vertex there = maps.neighbors[e];
      for (int a = 0; a < 2; ++a)
        worst.coordinates =
            std::max(worst.coordinates, std::abs(maps.logs[2 * e + a] - whole.coordinates(there)[a]) / radius);
      worst.distances = std::max(worst.distances, std::abs(maps.distances[e] - whole.distance(there)) / radius);
    }
  }
  return worst;
}

trimesh::TriangleMeshSurface torus_graph(Index n) {
  const Mesh mesh = torus(n);
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

}  // namespace

Table margins(const Settings& settings) {
  Table table({"vertices", "as", "variant", "R / h", "margin", "difference / R", "of distances"});
  const auto add_rows = [&](const auto& surface, const char* as) {
    const TangentGraph& graph = surface.graph();
    const double h = graph.mean_edge_length() * graph.length_unit();
    for (Variant variant : all_variants)
      for (double radius : {4.0, 10.0})
        for (double margin : {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0}) {
          const Difference found = difference(graph, radius * h, margin, variant);
          table.add({graph.size(), as, to_string(variant), radius, margin, found.coordinates, found.distances});
        }
  };
  for (Index n : sizes(settings, 6000, {10000})) {
    add_rows(torus_graph(n), "triangles");
    add_rows(pointcloud::PointCloudSurface::build(torus(n).positions), "points");
  }
  table.seen = fmt::format("With the default margin of 2 the boundary changes maps by at most {:.1g} of the radius.",
                           table.where("margin", "2").largest("difference / R"));
  return table;
}

Table local_maps(const Settings& settings) {
  Table table({"vertices", "R / h", "variant", "neighbours", "s", "maps per second", "times a loop of global solves",
               "peak MB"});
  for (Index n : sizes(settings, 600, {100000})) {
    const auto surface = torus_graph(n);
    const CsrGraph& graph = surface.graph();
    const double edge = graph.mean_edge_length() * graph.length_unit();
    const LogMapSolver solver(graph, {.strategy = Strategy::global, .check_graph = false});
    const double single =
        median_of_five([&] { solver.solve(Source::at_vertex(Vertex(n / 2)), {.threads = settings.threads}); });
    for (double radius : {5.4, 12.0})
      for (Variant variant : all_variants) {
        Offset entries = 0;
        const double s = seconds([&] {
          const LocalMapOptions options{
              .radius = radius * edge, .heat = {.variant = variant, .check_graph = false, .threads = settings.threads}};
          entries = ahm::local_maps(graph, options).indptr.back();
        });
        table.add({graph.size(), radius, to_string(variant), static_cast<double>(entries) / graph.size(), s,
                   graph.size() / s, single * graph.size() / s, peak_megabytes()});
      }
  }
  table.seen = fmt::format("{:.0f} to {:.0f} maps per second, at least {:.2g} times as many as one after the other.",
                           table.smallest("maps per second"), table.largest("maps per second"),
                           table.smallest("times a loop of global solves"));
  return table;
}

}  // namespace ahm::bench
