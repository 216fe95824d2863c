// Time and memory of every method over sizes, compared with the time that reading the data takes at least.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/surface_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "experiments/comparison.hpp"
#include "scaling/sizes.hpp"
#include "shapes.hpp"
#include "speed.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

/// Exact maps of larger meshes take minutes.
constexpr Index largest_exact = 700'000;
constexpr int batch = 16;
constexpr double longest_in_batch = 5;  // seconds of one map

std::unique_ptr<const ahm::Surface> build(bool is_mesh, Index n, unsigned threads) {
  if (!is_mesh)
    return std::make_unique<const pointcloud::PointCloudSurface>(
        pointcloud::PointCloudSurface::build(test::random_sphere(n).points, {}, {.threads = threads}));
  const Mesh mesh = jittered_icosphere(n, 0.15);
  return std::make_unique<const trimesh::TriangleMeshSurface>(
      trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, {.threads = threads}));
}

/// Bytes that an additional map reads and writes at least: neighbors, logarithms and transports of the graph, and the columns of the map.
/// Heat also reads its factors, exact maps their windows.
double least_bytes(const TangentGraph& graph, bool has_vectors) {
  const double vertices = graph.size(), edges = static_cast<double>(graph.edge_count());
  return edges * (sizeof(Index) + 4 * sizeof(double)) + vertices * sizeof(double) * (has_vectors ? 5 : 1);
}

struct MethodOfScaling {
  const char* name;
  std::optional<MethodOptions> options;  ///< none: only distances, which need no solver
};

std::vector<double> measure(bool is_mesh, Index n, const MethodOfScaling& method, unsigned threads) {
  std::unique_ptr<const ahm::Surface> surface;
  const double start = peak_megabytes();
  const double surface_time = seconds([&] { surface = build(is_mesh, n, threads); });
  std::optional<SurfaceSolver> solver;
  const auto solve = [&](Row source) {
    if (solver)
      solver->log_map(source);
    else
      distance(*surface, {source});
  };
  const double first = seconds([&] {
    if (method.options) solver.emplace(*surface, *method.options);
    solve(Row(n / 3));
  });
  const double peak = peak_megabytes() - start;
  const double additional = min_seconds([&] { solve(Row(n / 2)); });
  std::vector<Location> sources;
  for (Index k = 0; k < batch; ++k) sources.emplace_back(Row(k * (n / batch)));
  const bool is_batched = solver && additional < longest_in_batch;
  const double together =
      is_batched ? seconds([&] { solver->log_maps(sources); }) / batch : std::numeric_limits<double>::quiet_NaN();
  return {static_cast<double>(surface->graph().size()),      surface_time, first, additional, together,
          least_bytes(surface->graph(), solver.has_value()), peak};
}

}  // namespace

Table method_scaling(const Settings& settings) {
  Table table({"surface", "vertices", "method", "surface s", "first map s", "additional map s", "batch of 16, s each",
               "reading s", "added MB"});
  const unsigned threads = settings.threads;
  const double bandwidth = in_own_process(1, [] { return std::vector{copy_bandwidth()}; })[0];
  const MethodOfScaling methods[] = {
      {"distance", {}},
      {"polar", PolarSolverOptions{.threads = threads}},
      {"heat", HeatOptions{.strategy = Strategy::global, .threads = threads}},
      {"heat localized", HeatOptions{.variant = Variant::localized, .strategy = Strategy::global, .threads = threads}},
      {"exact", ExactSolverOptions{.threads = threads}}};
  for (const bool is_mesh : {true, false})
    for (const Index n :
         sizes(settings, 640,
               is_mesh ? std::vector<Index>{2562, 40962, 163842, 655362} : std::vector<Index>{100'000, 1'000'000}))
      for (const MethodOfScaling& method : methods) {
        const bool is_exact = method.options && std::holds_alternative<ExactSolverOptions>(*method.options);
        if (is_exact && (!is_mesh || n > largest_exact)) continue;
        auto numbers = in_own_process(7, [&] { return measure(is_mesh, n, method, threads); });
        numbers[5] /= bandwidth;
        std::vector<Cell> row{is_mesh ? "mesh" : "points", static_cast<Index>(numbers[0]), method.name};
        for (std::size_t k = 1; k < numbers.size(); ++k) row.push_back(known(numbers[k]));
        table.add(row);
      }
  const Table polar = table.where("method", "polar");
  table.seen =
      fmt::format("{:.0f} vertices take {:.2g} s to their first polar map, and {:.2g} s for each additional one.",
                  polar.largest("vertices"), polar.largest("surface s") + polar.largest("first map s"),
                  polar.largest("additional map s"));
  return table;
}

}  // namespace ahm::bench
