// Fig. 22: run time by size, of the first map and of additional ones, compared with the vector heat method.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "experiments/comparison.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

void measure(const std::string& name, const Mesh& mesh, unsigned threads, Table& table) {
  std::optional<Surface> surface;
  std::optional<LogMapSolver> solver;
  std::optional<methods::Method> vector_heat;
  const double build = min_seconds([&] { surface.emplace(name, mesh, trimesh::MeshOptions{.threads = threads}); });
  const TangentGraph& graph = surface->graph();
  const double factor = min_seconds([&] {
    solver.emplace(graph, HeatOptions{.strategy = Strategy::global, .check_graph = false, .threads = threads});
  });
  const Index source = graph.size() / 2;
  auto additional = [&](Variant variant) {
    return min_seconds(
        [&] { solver->solve(Source::at_vertex(Vertex(source)), {.variant = variant, .threads = threads}); });
  };
  const double adaptive = additional(Variant::adaptive), localized = additional(Variant::localized);
  std::vector<Source> sources;
  for (Index s = 0; s < 32; ++s)
    sources.push_back(Source::at_vertex(Vertex(static_cast<Offset>(s) * graph.size() / 32)));
  const double batch = min_seconds([&] { solver->solve(sources, {.threads = threads}); }) / 32;
  solver.reset();
  const double vector_factor = min_seconds([&] { vector_heat.emplace(methods::vector_heat_log(graph)); });
  const double vector_additional = min_seconds([&] { (*vector_heat)->solve(source); });
  table.add({name, graph.size(), build, factor, factor + adaptive, adaptive, factor + localized, localized, batch,
             vector_factor + vector_additional, vector_additional});
}

/// A generated surface: jittered sphere (0) or torus (1).
Mesh generated(int number, Index n) { return number == 0 ? jittered_icosphere(n, 0.15) : torus(n); }

double order(const Table& table, std::string_view what) {
  return fitted_order(table.numbers("vertices"), table.numbers(what));
}

}  // namespace

Table runtime(const Settings& settings) {
  Table table({"mesh", "vertices", "build s", "factor s", "first AHM_a s", "additional AHM_a s", "first AHM_l s",
               "additional AHM_l s", "batch of 32 s each", "first VHM_log s", "additional VHM_log s"});
  std::vector<Index> sizes{640, 2560};
  if (!settings.toy) sizes.insert(sizes.end(), {10000, 40000, 160000});
  for (int number : {0, 1})
    for (Index n : sizes) measure(number == 0 ? "sphere" : "torus", generated(number, n), settings.threads, table);
  for (const NamedMesh& mesh : user_meshes(settings))
    run_or_leave_out(mesh.name, [&] { measure(mesh.name, mesh, settings.threads, table); });
  auto ratio = [&](const char* a, const char* b) {
    std::vector<double> x = table.numbers(a), y = table.numbers(b);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] /= y[i];
    return quantile(x, 0.5);
  };
  table.seen = fmt::format(
      "The first map takes n^{:.2f}, an additional one n^{:.2f}. An additional AHM_a takes 1/{:.0f} of the first, "
      "AHM_l "
      "1/{:.0f}; the first AHM_a {:.2f} times, AHM_l {:.2f} times as long as VHM_log (medians).",
      order(table, "first AHM_a s"), order(table, "additional AHM_a s"), ratio("first AHM_a s", "additional AHM_a s"),
      ratio("first AHM_l s", "additional AHM_l s"), ratio("first AHM_a s", "first VHM_log s"),
      ratio("first AHM_l s", "first VHM_log s"));
  return table;
}

}  // namespace ahm::bench
