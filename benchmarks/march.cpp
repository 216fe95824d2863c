// One map by march and by a global solve: bench_march cloud|mesh march|global|both [vertices ...]
//
// Random spheres as clouds, icospheres as meshes. One process per size gives honest peak memory. The rows are Markdown.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "measure.hpp"
#include "shapes.hpp"

namespace {

using ahm::Strategy, ahm::bench::peak_megabytes, ahm::bench::seconds;

void solve(const ahm::TangentGraph& graph, Strategy strategy, double build) {
  const double n = graph.size(), before = peak_megabytes();
  std::optional<ahm::LogMapSolver> solver;
  std::optional<ahm::LogMap> map;
  const double prepare = seconds([&] {
    solver.emplace(graph, ahm::OperatorOptions{.check_graph = false}, ahm::SolverOptions{.strategy = strategy});
  });
  const double first = seconds([&] { map.emplace(solver->solve(ahm::Source::at_vertex(ahm::Vertex{0}))); });
  const double again = seconds([&] { solver->solve(ahm::Source::at_vertex(ahm::Vertex(graph.size() / 2))); });
  std::printf("| %d | %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %d | %d | %.0f | %.0f | %d |\n", graph.size(),
              std::string(to_string(strategy)).c_str(), build, build / n * 1e6, prepare + first,
              (prepare + first) / n * 1e6, again, static_cast<double>(map->march().solved) / n, map->march().bands,
              map->march().largest_band, before, peak_megabytes(), map->count(ahm::Status::ok));
  std::fflush(stdout);
}

void run(const ahm::TangentGraph& graph, const char* how, double build) {
  if (std::strcmp(how, "global") != 0) solve(graph, Strategy::march, build);
  if (std::strcmp(how, "march") != 0) solve(graph, Strategy::global, build);
}

}  // namespace

int main(int argc, char** argv) {
  const bool mesh = argc > 1 && std::strcmp(argv[1], "mesh") == 0;
  const char* how = argc > 2 ? argv[2] : "both";
  std::vector<ahm::Index> sizes;
  for (int a = 3; a < argc; ++a) sizes.push_back(std::atoi(argv[a]));
  if (sizes.empty()) sizes = {10000, 100000};
  std::printf("BLAS: %s\n\n", ahm::linear_algebra_info().blas.c_str());
  std::printf(
      "| vertices | strategy | graph s | graph us each | first map s | first map us each | second map s | solved per "
      "vertex | bands | "
      "largest band | MB with the graph | peak MB | ok |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (ahm::Index n : sizes) {
    if (mesh) {
      const auto shape = ahm::bench::icosphere(n);
      std::optional<ahm::trimesh::TriangleMeshSurface> surface;
      const double build =
          seconds([&] { surface.emplace(ahm::trimesh::TriangleMeshSurface::build(shape.points, shape.faces)); });
      run(surface->graph(), how, build);
    } else {
      const auto points = ahm::bench::random_sphere(n);
      std::optional<ahm::pointcloud::PointCloudSurface> cloud;
      const double build = seconds([&] { cloud.emplace(ahm::pointcloud::PointCloudSurface::build(points)); });
      run(cloud->graph(), how, build);
    }
  }
}
