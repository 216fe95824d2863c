// Local maps of every vertex, and how far their margins must reach: bench_local_maps [vertices [threads]]
#include "ahm/maps/local_maps.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "measure.hpp"
#include "shapes.hpp"

namespace {

using ahm::Index, ahm::LocalMaps, ahm::Offset, ahm::Variant, ahm::bench::seconds;

/// Largest difference to the maps of the whole graph, relative to the radius, over some sources.
double difference(const ahm::TangentGraph& graph, double radius, double margin, Variant variant) {
  const ahm::LogMapSolver solver(graph);
  std::vector<Index> sources;
  for (Index s = 0; s < graph.size(); s += graph.size() / 40) sources.push_back(s);
  const LocalMaps maps = ahm::local_maps(graph, sources, {.radius = radius, .variant = variant, .margin = margin});
  double worst = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const ahm::LogMap whole = solver.solve(ahm::Source::at_vertex(ahm::Vertex(sources[s])), {.variant = variant});
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e)
      for (int a = 0; a < 2; ++a)
        worst = std::max(worst, std::abs(maps.logs[2 * e + a] - whole.coordinates(ahm::Vertex(maps.indices[e]))[a]));
  }
  return worst / radius;
}

}  // namespace

int main(int argc, char** argv) {
  const Index wanted = argc > 1 ? std::atoi(argv[1]) : 100000;
  const unsigned threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0;

  std::printf("| margin | adaptive, R = 4 h | R = 10 h | localized, R = 4 h | R = 10 h |\n|---|---|---|---|---|\n");
  const auto small = ahm::bench::torus(10000);
  const auto coarse = ahm::trimesh::TriangleMeshSurface::build(small.points, small.faces);
  const double h = coarse.graph().mean_edge_length() * coarse.graph().length_unit();
  for (double margin : {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0}) {
    std::printf("| %g |", margin);
    for (Variant variant : {Variant::adaptive, Variant::localized})
      for (double radius : {4 * h, 10 * h}) std::printf(" %.1e |", difference(coarse.graph(), radius, margin, variant));
    std::printf("\n");
  }

  const auto shape = ahm::bench::torus(wanted);
  const auto surface = ahm::trimesh::TriangleMeshSurface::build(shape.points, shape.faces);
  const ahm::CsrGraph& graph = surface.graph();
  const double edge = graph.mean_edge_length() * graph.length_unit();
  std::optional<ahm::LogMapSolver> solver;
  const double factor = seconds([&] { solver.emplace(graph, ahm::OperatorOptions{.check_graph = false}); });
  std::vector<ahm::Source> some;
  for (Index s = 0; s < 64; ++s) some.push_back(ahm::Source::at_vertex(ahm::Vertex(s * (graph.size() / 64))));
  double batch = seconds([&] { solver->solve(some, {.threads = threads}); }) / 64;
  double single = seconds([&] {
                    for (const auto& source : some) solver->solve(source, {.threads = threads});
                  }) /
                  64;
  const std::size_t bytes = solver->operators().statistics().bytes;
  const std::vector<double> memory(bytes / sizeof(double), 1.0);
  double sum = 0;
  const double read = seconds([&] { sum = std::accumulate(memory.begin(), memory.end(), 0.0); });
  std::printf(
      "\n%d vertices; global: factor %.2f s, then %.1f ms per map one at a time, %.1f ms in a batch of 64; reading the "
      "%.0f MB of factors once takes %.0f ms\n\n",
      graph.size(), factor, 1e3 * single, 1e3 * batch, sum * 8e-6, 1e3 * read);
  std::printf(
      "| R / h | variant | neighbours | s | maps per second | times a loop of global solves | peak MB "
      "|\n|---|---|---|---|---|---|---|\n");
  for (double radius : {5.4, 12.0})
    for (Variant variant : {Variant::adaptive, Variant::localized}) {
      Offset entries = 0;
      const double s = seconds([&] {
        entries = ahm::local_maps(
                      graph, {.radius = radius * edge, .variant = variant, .check_graph = false, .threads = threads})
                      .indptr.back();
      });
      std::printf("| %g | %s | %.0f | %.2f | %.0f | %.0f | %.0f |\n", radius, std::string(to_string(variant)).c_str(),
                  static_cast<double>(entries) / graph.size(), s, graph.size() / s, single * graph.size() / s,
                  ahm::bench::peak_megabytes());
      std::fflush(stdout);
    }
}
