// Time and memory from triangles to log maps on icospheres.
#include <fmt/format.h>

#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"

namespace ahm::bench {
namespace {

std::vector<double> measure(Index n, const Settings& settings) {
  const Mesh mesh = split_icosphere(n);
  const MapOptions options{.threads = settings.threads}, alone{.threads = settings.threads, .distances = false};
  std::optional<trimesh::TriangleMeshSurface> surface;
  std::optional<LogMapSolver> solver;
  const double build = seconds([&] {
    surface.emplace(trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = settings.threads}));
  });
  const Source source = surface->source(Row(0)).source;
  const double first = seconds([&] {
    solver.emplace(surface->graph(), HeatOptions{.strategy = Strategy::global, .threads = settings.threads});
    solver->solve(source, options);
  });
  const double peak = peak_megabytes();
  const double adaptive = median_of_five([&] { solver->solve(source, options); });
  const double localized =
      median_of_five([&] { solver->solve(source, {.variant = Variant::localized, .threads = settings.threads}); });
  const double coordinates = median_of_five([&] { solver->solve(source, alone); });
  std::vector<Source> sources;
  for (Index s = 0; s < 64; ++s) sources.push_back(surface->source(Row(s * (mesh.vertices() / 64))).source);
  const double batch = seconds([&] { solver->solve(sources, options); });
  const double batch_alone = seconds([&] { solver->solve(sources, alone); });
  return {static_cast<double>(mesh.vertices()),
          build,
          first,
          adaptive,
          localized,
          coordinates,
          batch / 64,
          batch_alone / 64,
          peak};
}

}  // namespace

Table mesh_scaling(const Settings& settings) {
  Table table({"vertices", "graph s", "first map s", "additional adaptive s", "additional localized s",
               "u and v only s", "batch of 64, s each", "batch of u and v only, s each", "peak MB"});
  for (Index n : sizes(settings, 600, {10000, 40000, 160000})) {
    const std::vector<double> numbers = in_own_process(9, [&] { return measure(n, settings); });
    std::vector<Cell> row{static_cast<Index>(numbers[0])};
    row.insert(row.end(), numbers.begin() + 1, numbers.end());
    table.add(row);
  }
  table.seen = fmt::format("{:.0f} vertices take {:.2g} s to their first map and {:.0f} MB.", table.largest("vertices"),
                           table.largest("graph s") + table.largest("first map s"), table.largest("peak MB"));
  return table;
}

}  // namespace ahm::bench
