// Fig. 6: the plane, where the exact map is known.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "ahm/applications/distortion.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int near_rings = 3;  // radius, in mean edges, of the vertices near the source

void measure(const std::string& name, const Mesh& mesh, Table& table) {
  const Surface surface(name, mesh);
  const Index source = test::nearest(mesh, {0.5, 0.5});
  const std::vector<double> exact = surface.plane_log(source), distance = lengths(exact);
  const double diameter = mesh.diameter(), near = near_rings * surface.mean_edge();
  for (const NamedMethod& method : log_map_methods()) {
    const auto map = method.make(surface.graph())->solve(source).coordinates;
    const Errors all = errors(map, exact, [](std::size_t) { return true; });
    const Errors close = errors(map, exact, [&](std::size_t i) { return distance[i] <= near; });
    const auto D = summary(distortion(surface.points(), surface.faces(), map));
    table.add({name, surface.size(), method.name, all.rms / diameter, all.largest / diameter,
               close.rms / surface.mean_edge(), D.median, D.percentile_95, D.flipped_area, all.missing});
  }
}

}  // namespace

Table flat(const Settings& settings) {
  Table table({"mesh", "vertices", "method", "rms / diameter", "largest / diameter", "rms near source / h", "median D",
               "95% D", "flipped area", "missing"});
  const Index side = settings.toy ? 21 : 101;
  measure("regular", test::flat_square(side, 0.0), table);
  measure("jittered", test::flat_square(side), table);
  measure("holes", test::holed_square(side), table);
  measure("slivers", test::sliver_square(side * side / 4), table);
  auto worst = [&](const char* method) { return table.where("method", method).largest("largest / diameter"); };
  table.seen = fmt::format(
      "Largest error relative to the diameter: AHM_a {:.1g}, AHM_l {:.1g} and DEM {:.1g} (rounding), VHM_log {:.2g}, "
      "SEM {:.2g}.",
      worst("AHM_a"), worst("AHM_l"), worst("DEM"), worst("VHM_log"), worst("SEM"));
  return table;
}

}  // namespace ahm::bench
