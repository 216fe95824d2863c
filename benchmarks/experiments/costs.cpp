// Polar, heat and exact maps of the same meshes: time, memory, and errors of the vectors.
#include <fmt/format.h>

#include <optional>

#include "ahm/surface/surface_solver.hpp"
#include "experiments/comparison.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 3;
constexpr Index largest_mesh = 200'000;

MethodOptions options_of(Method method, unsigned threads) {
  switch (method) {
    case Method::heat:
      return HeatOptions{.threads = threads};
    case Method::exact:
      return ExactSolverOptions{.threads = threads};
    case Method::polar:
      break;
  }
  return PolarSolverOptions{.threads = threads};
}

void measure(const NamedMesh& mesh, unsigned threads, Table& table) {
  const trimesh::MeshOptions options{.threads = threads};
  std::optional<Surface> surface;
  const double build = min_seconds([&] { surface.emplace(mesh.name, mesh, options); });
  std::vector<Vertex> sources;
  std::vector<LogMap> exact;
  const ExactGeodesics geodesics(surface->mesh());
  for (Index s = 0; s < source_count; ++s) {
    sources.emplace_back(surface->size() / 11 + s * (surface->size() / source_count));
    exact.push_back(geodesics.log_map(sources.back()));
  }
  const auto row = [&](Vertex source) { return *surface->mesh().rows().row(source); };
  for (const Method method : {Method::polar, Method::heat, Method::exact}) {
    std::optional<SurfaceSolver> solver;
    std::vector<double> vectors;
    const double prepare = min_seconds([&] { solver.emplace(surface->mesh(), options_of(method, threads)); });
    const double additional = min_seconds([&] { solver->log_map(row(sources.front())); });
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const LogMap map = solver->log_map(row(sources[s])).vertices;
      const std::vector<double> errors = vector_errors(*surface, exact[s], map);
      vectors.insert(vectors.end(), errors.begin(), errors.end());
    }
    solver.reset();
    const double memory = added_megabytes([&] {
      const Surface own(mesh.name, mesh, options);
      SurfaceSolver(own.mesh(), options_of(method, threads)).log_map(row(sources.front()));
    });
    table.add({mesh.name, surface->size(), std::string(to_string(method)), build, prepare + additional, additional,
               known(memory), quantile(vectors, 0.5), quantile(vectors, 0.95)});
  }
}

}  // namespace

Table costs(const Settings& settings) {
  Table table({"mesh", "vertices", "method", "surface s", "first map s", "additional map s", "added MB", "vector 50%",
               "vector 95%"});
  const auto size = [&](Index n) { return settings.toy ? 640 : n; };
  for (const NamedMesh& mesh :
       {NamedMesh{jittered_icosphere(size(2562), 0.15), "sphere"}, NamedMesh{torus(size(10000)), "torus"},
        NamedMesh{bumpy_sphere(size(10242)), "bumpy sphere"}, NamedMesh{ellipsoid(size(40962)), "ellipsoid"},
        NamedMesh{bumpy_sphere(size(40962)), "bumpy sphere"},
        NamedMesh{jittered_icosphere(size(163842), 0.15), "sphere"}})
    measure(mesh, settings.threads, table);
  for (const NamedMesh& mesh : user_meshes(settings, largest_mesh)) try {
      measure(mesh, settings.threads, table);
    } catch (const Error& e) {
      fmt::print(stderr, "left out: {}: {}\n", mesh.name, e.what());
    }
  const auto median = [&](const char* method, const char* column) {
    return quantile(table.where("method", method).numbers(column), 0.5);
  };
  table.seen = fmt::format(
      "Polar / heat / exact, medians over the meshes: {:.2g} / {:.2g} / {:.2g} s to the first map of a surface, "
      "vectors off by {:.2g} / {:.2g} / 0 of the distance at the 95th percentile.",
      median("polar", "first map s"), median("heat", "first map s"), median("exact", "first map s"),
      median("polar", "vector 95%"), median("heat", "vector 95%"));
  return table;
}

}  // namespace ahm::bench
