// Fig. 14: maps with and without the intrinsic Delaunay triangulation, on spheres of good and bad triangles.
#include <fmt/format.h>

#include "ahm/error.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr double within = 0.85 * std::numbers::pi;  // away from the cut locus

struct Triangulation {
  const char* name;
  trimesh::MeshOptions options;
};

void measure(const char* name, const Mesh& mesh, const Triangulation& triangulation, Table& table) {
  const Surface surface(name, mesh, triangulation.options);
  const Index source = surface.size() / 3;
  const std::vector<double> exact = surface.sphere_log(source), distance = lengths(exact);
  const trimesh::MeshDetails& report = surface.mesh().details();
  for (const NamedMethod& method : log_map_methods().first(2)) {
    std::vector<Cell> row{name, surface.size(), triangulation.name, method.name, report.flips, report.clamped_weights};
    try {
      const auto map = method.make(surface.graph())->solve(source).coordinates;
      const Errors e = errors(map, exact, [&](std::size_t i) { return distance[i] <= within; });
      row.insert(row.end(), {known(e.rms), known(e.largest), e.missing, "yes"});
    } catch (const NotPositiveDefinite&) {
      row.insert(row.end(), {{}, {}, {}, "no"});
    }
    table.add(row);
  }
}

}  // namespace

Table delaunay(const Settings& settings) {
  Table table({"mesh", "vertices", "triangulation", "method", "flips", "clamped weights", "rms", "largest", "missing",
               "positive definite"});
  const Triangulation triangulations[] = {
      {"intrinsic Delaunay", {}},
      {"as given", {.intrinsic_delaunay = false}},
      {"as given, negative weights", {.intrinsic_delaunay = false, .clamp_weights = false}}};
  const Index n = settings.toy ? 600 : 2500;
  for (const Triangulation& t : triangulations) {
    measure("icosphere", split_icosphere(n), t, table);
    measure("thin across", settings.toy ? parallels_and_meridians(12, 50) : parallels_and_meridians(25, 100), t, table);
    measure("thin along", settings.toy ? parallels_and_meridians(50, 12) : parallels_and_meridians(100, 25), t, table);
    measure("needles", with_needles(n), t, table);
    measure("slivers", sliver_sphere(4 * n), t, table);
  }
  auto rms = [&](const char* triangulation) {
    return table.where("triangulation", triangulation).where("method", "AHM_a").where("mesh", "slivers").mean("rms");
  };
  table.seen = fmt::format("On slivers AHM_a has a root mean square error of {:.2g} with the flips and {:.2g} without.",
                           rms("intrinsic Delaunay"), rms("as given"));
  return table;
}

}  // namespace ahm::bench
