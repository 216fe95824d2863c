// Fig. 27: planar mazes, where straight lines from the source reach only few points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/conformance/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {

Table mazes(const Settings& settings) {
  Table table({"cells", "vertices", "method", "longest path / diameter", "longest path / h", "rms / diameter",
               "largest / diameter", "missing"});
  for (Index cells : settings.toy ? std::vector<Index>{4, 8} : std::vector<Index>{5, 10, 20, 40}) {
    const Mesh maze = test::maze(cells);
    const Surface surface("maze", maze);
    const std::vector<double> exact = surface.plane_log(0), paths = surface.path_lengths(0);
    const double diameter = maze.diameter(), longest = std::ranges::max(paths);
    for (const NamedMethod& method : log_map_methods()) {
      const auto map = method.make(surface.graph())->solve(0).coordinates;
      const Errors e = errors(map, exact, [](std::size_t) { return true; });
      table.add({cells, surface.size(), method.name, longest / diameter, longest / surface.mean_edge(),
                 e.rms / diameter, e.largest / diameter, e.missing});
    }
  }
  auto worst = [&](const char* method) { return table.where("method", method).largest("largest / diameter"); };
  table.seen = fmt::format(
      "The errors of AHM_a and AHM_l are {:.1g} of the diameter, even where the path to the source is {:.0f} diameters "
      "long; "
      "VHM_log {:.2g}, SEM {:.2g}.",
      std::max(worst("AHM_a"), worst("AHM_l")), table.largest("longest path / diameter"), worst("VHM_log"),
      worst("SEM"));
  return table;
}

}  // namespace ahm::bench
