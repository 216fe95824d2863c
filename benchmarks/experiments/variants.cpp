// Fig. 8: the difference between the localized and the adaptive variant.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int ring_count = 10;

void measure(const Surface& surface, Table& table) {
  const Index source = surface.size() / 2;
  const LogMapSolver solver(surface.graph());
  const LogMap adaptive = solver.solve(Source::at_vertex(Vertex(source)), {.frames = true}),
               localized = solver.solve(Source::at_vertex(Vertex(source)), {.variant = Variant::localized});
  const std::vector<double> quality = map_quality(surface.graph(), adaptive), paths = surface.path_lengths(source);
  const std::vector<int> ring_of = rings(paths, ring_count);
  double longest = 0;
  for (Index i = 0; i < adaptive.size(); ++i)
    if (adaptive.status(Vertex(i)) == Status::ok) longest = std::max(longest, adaptive.distance(Vertex(i)));
  for (int ring = 0; ring < ring_count; ++ring) {
    std::vector<double> all, kept;
    for (Index i = 0; i < adaptive.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (ring_of[k] != ring || adaptive.status(Vertex(i)) != Status::ok || localized.status(Vertex(i)) != Status::ok)
        continue;
      const auto a = adaptive.coordinates(Vertex(i)), l = localized.coordinates(Vertex(i));
      all.push_back(std::hypot(a[0] - l[0], a[1] - l[1]) / longest);
      if (quality[k] >= reliable_quality) kept.push_back(all.back());
    }
    if (all.empty()) continue;
    table.add({surface.name(), surface.size(), (ring + 0.5) / ring_count, quantile(all, 0.5), mean(all),
               quantile(all, 0.95), quantile(all, 1), kept.empty() ? Cell() : Cell(quantile(kept, 0.5)),
               static_cast<double>(kept.size()) / static_cast<double>(all.size())});
  }
}

}  // namespace

Table variants(const Settings& settings) {
  Table table({"shape", "vertices", "distance / longest", "median difference", "mean difference", "95% difference",
               "largest difference", "median difference, kept", "kept share"});
  const Index n = settings.toy ? 600 : 40000;
  measure(Surface("sphere", split_icosphere(n)), table);
  measure(Surface("ellipsoid", ellipsoid(n)), table);
  measure(Surface("bumpy sphere", bumpy_sphere(n)), table);
  measure(Surface("torus", torus(n)), table);
  for_user_surfaces(settings, 200000, [&](const Surface& surface) { measure(surface, table); });
  table.seen = fmt::format(
      "Median differences, relative to the largest distance: up to {:.2g} where the quality is above 0.5, up to {:.2g} "
      "elsewhere.",
      table.largest("median difference, kept"), table.largest("median difference"));
  return table;
}

}  // namespace ahm::bench
