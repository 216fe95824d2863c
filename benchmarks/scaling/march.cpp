// One map by march and by a global solve, on random spheres as clouds and icospheres as meshes.
#include <fmt/format.h>

#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"

namespace ahm::bench {
namespace {

std::vector<double> solve(const TangentGraph& graph, Strategy strategy, double build, const Settings& settings) {
  const double n = graph.size(), before = peak_megabytes();
  const MapOptions options{.threads = settings.threads};
  std::optional<LogMapSolver> solver;
  std::optional<LogMap> map;
  const double prepare = seconds([&] {
    solver.emplace(graph, HeatOptions{.strategy = strategy, .check_graph = false, .threads = settings.threads});
  });
  const double first = seconds([&] { map.emplace(solver->solve(Source::at_vertex(Vertex{0}), options)); });
  const double again = seconds([&] { solver->solve(Source::at_vertex(Vertex(graph.size() / 2)), options); });
  return {n,
          build,
          build / n * 1e6,
          prepare + first,
          (prepare + first) / n * 1e6,
          again,
          static_cast<double>(map->march().solved) / n,
          static_cast<double>(map->march().bands),
          static_cast<double>(map->march().largest_band),
          before,
          peak_megabytes(),
          static_cast<double>(map->count(Status::ok))};
}

std::vector<double> measure(bool mesh, Index n, Strategy strategy, const Settings& settings) {
  if (mesh) {
    const Mesh shape = split_icosphere(n);
    std::optional<trimesh::TriangleMeshSurface> surface;
    const double build = seconds([&] {
      surface.emplace(trimesh::TriangleMeshSurface::build(shape.positions, shape.faces, {.threads = settings.threads}));
    });
    return solve(surface->graph(), strategy, build, settings);
  }
  const std::vector<Vec3> points = test::random_sphere(n).points;
  std::optional<pointcloud::PointCloudSurface> cloud;
  const double build =
      seconds([&] { cloud.emplace(pointcloud::PointCloudSurface::build(points, {}, {.threads = settings.threads})); });
  return solve(cloud->graph(), strategy, build, settings);
}

}  // namespace

Table march(const Settings& settings) {
  Table table({"shape", "strategy", "vertices", "graph s", "graph us each", "first map s", "first map us each",
               "second map s", "solved per vertex", "bands", "largest band", "MB with the graph", "peak MB", "ok"});
  for (const char* shape : {"cloud", "mesh"})
    for (Index n : sizes(settings, 2000, {10000, 100000}))
      for (Strategy strategy : {Strategy::march, Strategy::global}) {
        std::vector<Cell> row{shape, to_string(strategy)};
        const bool mesh = shape == std::string_view("mesh");
        for (double number : in_own_process(12, [&] { return measure(mesh, n, strategy, settings); }))
          row.push_back(number);
        table.add(row);
      }
  auto memory = [&](const char* strategy) { return table.where("strategy", strategy).largest("peak MB"); };
  table.seen = fmt::format("A map of {:.0f} vertices takes {:.0f} MB by march and {:.0f} MB by global factors.",
                           table.largest("vertices"), memory("march"), memory("global"));
  return table;
}

}  // namespace ahm::bench
