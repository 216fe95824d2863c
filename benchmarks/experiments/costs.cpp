// Maps and distances of the same meshes by libahm and by other methods: time, memory, and errors.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include "ahm/surface/surface_solver.hpp"
#include "experiments/comparison.hpp"
#include "timing.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 3;
constexpr Index largest_mesh = 200'000;
/// CGAL's exact distances need minutes and 17 GB on 164,000 vertices.
[[maybe_unused]] constexpr Index largest_for_cgal = 50'000;

/// Coordinates in the axes of the source's vertex, and distances, world units; either may be empty.
struct Answer {
  std::vector<double> coordinates, distance;
};
using Solve = std::function<Answer(Index source)>;

/// A method: what it computes once for a surface, and its answer for a source.
struct Contender {
  std::string name;
  std::function<Solve(const Surface&)> prepare;
};

Contender maps_of_libahm(const char* name, const MethodOptions& options) {
  return {name, [options](const Surface& surface) -> Solve {
            const auto solver = std::make_shared<const SurfaceSolver>(surface.mesh(), options);
            return [solver, &surface](Index source) {
              const LogMap map = solver->log_map(*surface.mesh().rows().row(Vertex(source))).vertices;
              return Answer{{map.coordinates().begin(), map.coordinates().end()},
                            {map.distances().begin(), map.distances().end()}};
            };
          }};
}

Contender baseline(const char* name, std::function<methods::Method(const Surface&)> make) {
  return {name, [make = std::move(make)](const Surface& surface) -> Solve {
            const std::shared_ptr<const methods::Baseline> method = make(surface);
            return [method](Index source) {
              methods::Result result = method->solve(source);
              return Answer{std::move(result.coordinates), std::move(result.distance)};
            };
          }};
}

std::vector<Contender> contenders([[maybe_unused]] Index vertices, unsigned threads) {
  const HeatOptions adaptive{.threads = threads}, localized{.variant = Variant::localized, .threads = threads};
  std::vector<Contender> all;
  all.push_back({"distance", [](const Surface& surface) -> Solve {
                   return [&surface](Index source) {
                     const RowMap& rows = surface.mesh().rows();
                     const std::vector<double> of_rows = distance(surface.mesh(), {*rows.row(Vertex(source))});
                     Answer answer;
                     for (Index i = 0; i < surface.size(); ++i) {
                       const auto row = rows.row(Vertex(i));
                       answer.distance.push_back(row ? of_rows[row->index] : NAN);
                     }
                     return answer;
                   };
                 }});
  all.push_back(maps_of_libahm("polar", PolarSolverOptions{.threads = threads}));
  all.push_back(maps_of_libahm("heat", adaptive));
  all.push_back(maps_of_libahm("heat localized", localized));
  all.push_back(maps_of_libahm("exact", ExactSolverOptions{.threads = threads}));
  all.push_back(baseline("VHM_log", [](const Surface& s) { return methods::vector_heat_log(s.graph()); }));
  all.push_back(baseline("HM", [](const Surface& s) { return methods::heat_distance(s.mesh().mesh()); }));
  all.push_back({"Dijkstra", [](const Surface& surface) -> Solve {
                   return [&surface](Index source) { return Answer{{}, surface.path_lengths(source)}; };
                 }});
#ifdef AHM_METHODS_CGAL
  if (vertices <= largest_for_cgal)
    all.push_back(baseline("CGAL", [](const Surface& s) { return methods::exact_distance(s.points(), s.faces()); }));
#endif
  return all;
}

/// Appends relative errors beyond two mean edges.
void add_errors(const Surface& surface, const LogMap& exact, const Answer& answer, std::vector<double>& of_vectors,
                std::vector<double>& of_distances) {
  for (Index i = 0; i < surface.size(); ++i) {
    const double distance = exact.distance(Vertex(i));
    if (!(distance > 2 * surface.mean_edge())) continue;
    const auto add = [&](double error, std::vector<double>& errors) {
      if (std::isfinite(error)) errors.push_back(error / distance);
    };
    const auto a = exact.coordinates(Vertex(i));
    if (!answer.coordinates.empty())
      add(std::hypot(answer.coordinates[2 * i] - a[0], answer.coordinates[2 * i + 1] - a[1]), of_vectors);
    if (!answer.distance.empty()) add(std::abs(answer.distance[i] - distance), of_distances);
  }
}

void measure(const NamedMesh& mesh, unsigned threads, Table& table) {
  const trimesh::MeshOptions options{.threads = threads};
  std::optional<Surface> surface;
  const double build = min_seconds([&] { surface.emplace(mesh.name, mesh, options); });
  std::vector<Index> sources;
  std::vector<LogMap> exact;
  const ExactGeodesics geodesics(surface->mesh());
  for (Index s = 0; s < source_count; ++s) {
    sources.push_back(surface->size() / 11 + s * (surface->size() / source_count));
    exact.push_back(geodesics.log_map(Vertex(sources.back())));
  }
  for (const Contender& contender : contenders(surface->size(), threads)) try {
      // On a surface of its own: the graph keeps the one-rings of earlier calls.
      const double first = least_seconds([&] {
        const Surface own(mesh.name, mesh, options);
        return seconds([&] { contender.prepare(own)(sources.front()); });
      });
      Solve solve = contender.prepare(*surface);
      const double additional = min_seconds([&] { solve(sources.front()); });
      std::vector<double> vectors, distances;
      for (std::size_t s = 0; s < sources.size(); ++s)
        add_errors(*surface, exact[s], solve(sources[s]), vectors, distances);
      solve = nullptr;
      const double memory = added_megabytes([&] {
        const Surface own(mesh.name, mesh, options);
        contender.prepare(own)(sources.front());
      });
      const auto share = [](const std::vector<double>& errors, double q) {
        return known(errors.empty() ? NAN : quantile(errors, q));
      };
      table.add({mesh.name, surface->size(), contender.name, build, first, additional, known(memory),
                 share(vectors, 0.5), share(vectors, 0.95), share(distances, 0.95)});
    } catch (const Error& e) {
      fmt::print(stderr, "left out: {} of {}: {}\n", contender.name, mesh.name, e.what());
    }
}

}  // namespace

Table costs(const Settings& settings) {
  Table table({"mesh", "vertices", "method", "surface s", "first map s", "additional map s", "added MB", "vector 50%",
               "vector 95%", "distance 95%"});
  const auto size = [&](Index n) { return settings.toy ? 640 : n; };
  for (const NamedMesh& mesh :
       {NamedMesh{jittered_icosphere(size(2562), 0.15), "sphere"}, NamedMesh{torus(size(10000)), "torus"},
        NamedMesh{bumpy_sphere(size(10242)), "bumpy sphere"}, NamedMesh{ellipsoid(size(40962)), "ellipsoid"},
        NamedMesh{bumpy_sphere(size(40962)), "bumpy sphere"},
        NamedMesh{jittered_icosphere(size(163842), 0.15), "sphere"}})
    measure(mesh, settings.threads, table);
  for (const NamedMesh& mesh : user_meshes(settings, largest_mesh))
    run_or_leave_out(mesh.name, [&] { measure(mesh, settings.threads, table); });
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
