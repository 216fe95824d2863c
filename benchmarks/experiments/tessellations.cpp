// Fig. 23: spheres of few and of bad triangles. All methods use the intrinsic Delaunay triangulation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/applications/distortion.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

/// @param exact  log map, n x 2; empty where it is unknown
void measure(const Surface& surface, Index source, std::span<const double> exact, std::span<const double> distance,
             double within, Table& table) {
  for (const NamedMethod& method : log_map_methods()) {
    const methods::Result found = method.make(surface.graph())->solve(source);
    const Errors e = errors(found.coordinates, exact, [&](std::size_t i) { return distance[i] <= within; });
    const DistortionSummary D = summary(ahm::distortion(surface.points(), surface.faces(), found.coordinates));
    table.add({surface.name(), surface.size(), method.name, exact.empty() ? Cell() : Cell(e.rms),
               exact.empty() ? Cell() : Cell(e.largest), distance_rms(found.distance, distance, within),
               known(D.median), known(D.percentile_95), known(D.flipped_area), e.missing});
  }
}

/// Measures a mesh of the unit sphere against the closed form.
void measure_sphere(const char* name, const Mesh& mesh, Table& table) {
  const Surface surface(name, mesh);
  const Index source = surface.size() / 3;
  const std::vector<double> exact = surface.sphere_log(source), distance = lengths(exact);
  measure(surface, source, exact, distance, 0.85 * std::numbers::pi, table);  // away from the cut locus
}

/// Measures coarse meshes against exact distances on a much finer one, which begins with their vertices.
void measure_bumpy([[maybe_unused]] const Settings& settings, [[maybe_unused]] Table& table) {
#ifdef AHM_METHODS_CGAL
  const Mesh fine = bumpy_sphere(settings.toy ? 2562 : 10242);
  const Index source = 17;
  std::vector<double> exact = methods::exact_distance(fine.positions, fine.faces)->solve(source).distance;
  const double within = 0.75 * std::ranges::max(exact);
  for (Index n : {162, 642, 2562}) {
    if (2 * n > static_cast<Index>(fine.positions.size())) break;
    const Surface coarse(fmt::format("bumpy {}", n), bumpy_sphere(n));
    measure(coarse, source, {}, std::span(exact).first(static_cast<std::size_t>(n)), within, table);
  }
#endif
}

}  // namespace

Table tessellations(const Settings& settings) {
  Table table(
      {"mesh", "vertices", "method", "rms", "largest", "distance rms", "median D", "95% D", "flipped area", "missing"});
  measure_sphere("icosphere 42", split_icosphere(42), table);
  measure_sphere("icosphere 162", split_icosphere(162), table);
  measure_sphere("icosphere 642", split_icosphere(642), table);
  measure_sphere("jittered 642", jittered_icosphere(642, 0.3), table);
  measure_sphere("thin across", settings.toy ? parallels_and_meridians(8, 32) : parallels_and_meridians(12, 96), table);
  measure_sphere("thin along", settings.toy ? parallels_and_meridians(32, 8) : parallels_and_meridians(96, 12), table);
  measure_sphere("needles", with_needles(settings.toy ? 162 : 642), table);
  measure_sphere("slivers", sliver_sphere(settings.toy ? 1200 : 2500), table);
  measure_bumpy(settings, table);
  std::string means;
  for (const NamedMethod& method : log_map_methods()) {
    const Table rows = table.where("method", method.name);
    append(means, fmt::format("{} {:.2f} / {:.2f}", method.name, rows.mean("rms"), rows.largest("rms")));
  }
  table.seen = "Root mean square error on the spheres, radius 1, mean / worst of the meshes: " + means + ".";
  return table;
}

}  // namespace ahm::bench
