// Local maps of every vertex by both methods compared with exact maps, and the margin that heat needs.
#include "ahm/maps/local_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <random>
#include <string>
#include <string_view>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/row_local_maps.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "experiments/comparison.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"
#include "timing.hpp"

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

namespace {

/// Errors of local maps relative to the distance.
struct LocalErrors {
  std::vector<double> vectors, distances;
};

/// Compares local maps with exact maps of the mesh.
/// @param cloud  whether the rows are the mesh's vertices as points, with other frames
LocalErrors errors(const Surface& surface, const RowLocalMaps& maps, std::span<const Row> sources, bool cloud) {
  const ExactGeodesics geodesics(surface.mesh());
  LocalErrors found;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const auto begin = maps.indptr[s], end = maps.indptr[s + 1];
    double radius = surface.mean_edge();
    for (Offset e = begin; e < end; ++e) radius = std::max(radius, maps.distances[e]);
    const auto vertex = [&](Row row) { return cloud ? Vertex(row.index) : surface.mesh().vertex(row); };
    const LogMap exact = geodesics.log_map(vertex(sources[s]), {.radius = 2 * radius});
    std::vector<std::complex<double>> ours, truth;
    for (Offset e = begin; e < end; ++e) {
      const Vertex there = vertex(maps.neighbors[e]);
      if (exact.status(there) != Status::ok || !(exact.distance(there) > 0)) continue;
      ours.emplace_back(maps.logs[2 * e], maps.logs[2 * e + 1]);
      truth.emplace_back(exact.coordinates(there)[0], exact.coordinates(there)[1]);
      const double d = exact.distance(there);
      found.distances.push_back(std::abs(maps.distances[e] - d) / d);
      if (!cloud) found.vectors.push_back(std::abs(ours.back() - truth.back()) / d);
    }
    if (!cloud || ours.size() < 3) continue;
    const std::vector<double> turned = relative_errors(ours, truth);  // the frames are fitted
    found.vectors.insert(found.vectors.end(), turned.begin(), turned.end());
  }
  return found;
}

constexpr Index neighbors = 64, compared_sources = 200;

/// The vertices of a mesh, moved along its normals.
/// @param noise  standard deviation, in mean edge lengths
std::vector<Vec3> noisy_points(const Surface& surface, double noise) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> off(0, noise * surface.mean_edge());
  std::vector<Vec3> points(surface.points().begin(), surface.points().end());
  for (Index v = 0; noise > 0 && v < surface.size(); ++v)
    if (const auto frame = surface.graph().frame(v)) points[v] = points[v] + off(random) * frame->normal;
  return points;
}

/// Processor time of one map of the whole graph after another, around every vertex, by operators that are factored before; s.
/// Extrapolated from some vertices. The maps have coordinates and transports, but no distances, which would take longer.
double seconds_of_loop(const TangentGraph& graph, std::span<const Vertex> vertices) {
  const LogMapSolver solver(graph, {.strategy = Strategy::global, .check_graph = false});
  const double some = processor_seconds([&] {
    for (const Vertex v : vertices)
      solver.solve(Source::at_vertex(v),
                   {.variant = Variant::localized, .frames = true, .spread = false, .distances = false});
  });
  return some * graph.size() / static_cast<double>(vertices.size());
}

void measure_local_maps(const Surface& surface, const ahm::Surface& view, std::string_view as, const Settings& settings,
                        Table& table) {
  std::vector<Row> rows;
  std::vector<Vertex> vertices;
  const Index n = static_cast<Index>(surface.size()), step = std::max(1, n / compared_sources);
  for (Index r = step / 2; r < view.rows().row_count(); r += step)
    if (view.rows().vertex(Row(r))) {
      rows.emplace_back(r);
      vertices.push_back(view.vertex(Row(r)));
    }
  const double loop = seconds_of_loop(view.graph(), vertices);
  for (const Method method : {Method::polar, Method::heat}) {
    const LocalMapOptions options{
        .k = neighbors, .method = method, .heat = {.check_graph = false, .threads = settings.threads}};
    const LocalErrors found = errors(surface, row_local_maps(view, vertices, options), rows, as != "triangles");
    if (found.vectors.empty()) continue;
    double entries = 0, processor = 0;
    const double s = seconds([&] {
      processor =
          processor_seconds([&] { entries = static_cast<double>(row_local_maps(view, options).indptr.back()); });
    });
    const double added = added_megabytes([&] { row_local_maps(view, options); });
    const double result =
        1e-6 * entries * (sizeof(Row) + sizeof(double) * (2 + 2 + (view.graph().transport_layout().width())));
    table.add({surface.name(), as, view.graph().size(), to_string(method), entries / view.graph().size(), s, processor,
               view.graph().size() / s, loop / processor, quantile(found.vectors, 0.5), quantile(found.vectors, 0.95),
               quantile(found.distances, 0.95), result, added});
  }
}

}  // namespace

Table local_maps(const Settings& settings) {
  Table table({"mesh", "as", "vertices", "method", "neighbors", "s", "processor s", "maps per second",
               "faster than a loop", "vector 50%", "vector 95%", "distance 95%", "result MB", "peak MB"});
  const auto measure = [&](const Surface& surface) {
    measure_local_maps(surface, surface.mesh(), "triangles", settings, table);
    const std::vector<double> noises = settings.toy ? std::vector<double>{0} : std::vector<double>{0, 0.2, 1};
    for (const double noise : noises) {
      const std::string as = noise > 0 ? fmt::format("points, noise {}", noise) : "points";
      measure_local_maps(surface, pointcloud::PointCloudSurface::build(noisy_points(surface, noise)), as, settings,
                         table);
    }
  };
  for (const Index n : sizes(settings, 600, {6890})) {
    measure(Surface("sphere", test::split_icosphere(n)));
    measure(Surface("torus", torus(n)));
  }
  for_user_surfaces(settings, 30'000, measure);
  table.seen = vector_error_summary(table);
  return table;
}

}  // namespace ahm::bench
