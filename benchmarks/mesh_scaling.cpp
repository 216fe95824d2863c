// Time and memory from triangles to log maps on icospheres: bench_mesh_scaling [vertices ...]
//
// One process per size gives honest peak memory. Seconds of wall-clock time; "first" is factorization and map, as
// further maps are the map alone. The rows are Markdown.
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "measure.hpp"
#include "shapes.hpp"

namespace {

void run(ahm::Index n) {
  using namespace ahm::bench;
  const Mesh mesh = icosphere(n);
  std::optional<ahm::trimesh::TriangleMeshSurface> surface;
  std::optional<ahm::LogMapSolver> solver;
  const double build =
      seconds([&] { surface.emplace(ahm::trimesh::TriangleMeshSurface::build(mesh.points, mesh.faces)); });
  const ahm::Source source = surface->source(ahm::Row(0)).source;
  const double first = seconds([&] {
    solver.emplace(surface->graph());
    solver->solve(source);
  });
  const double peak = peak_megabytes();
  const double adaptive = median_of_five([&] { solver->solve(source); });
  const double localized = median_of_five([&] { solver->solve(source, {.variant = ahm::Variant::localized}); });
  std::vector<ahm::Source> sources;
  for (ahm::Index s = 0; s < 64; ++s)
    sources.push_back(surface->source(ahm::Row(s * static_cast<ahm::Index>(mesh.points.size() / 64))).source);
  const double batch = seconds([&] { solver->solve(sources); });
  std::printf("| %zu | %.2f | %.3f | %.4f | %.4f | %.4f | %.0f |\n", mesh.points.size(), build, first, adaptive,
              localized, batch / 64, peak);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("BLAS: %s\n\n", ahm::linear_algebra_info().blas.c_str());
  std::printf(
      "| vertices | graph s | first map s | further adaptive s | further localized s | batch of 64, s each | peak MB "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  std::vector<ahm::Index> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atoi(argv[a]));
  if (sizes.empty()) sizes = {10000, 40000, 160000};
  for (ahm::Index n : sizes) run(n);
}
