// Fig. 2 and 26: metric distortion of the maps, by distance from the source.
#include "ahm/applications/distortion.hpp"

#include <fmt/format.h>

#include "ahm/conformance/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int ring_count = 10;

void add(const Surface& surface, std::span<const int> ring_of, std::string_view method, std::span<const double> map,
         Table& table) {
  const std::vector<TriangleDistortion> all = ahm::distortion(surface.points(), surface.faces(), map);
  std::vector<std::vector<TriangleDistortion>> by_ring(ring_count);
  for (std::size_t f = 0; f < all.size(); ++f)
    if (const int ring = ring_of[surface.faces()[f][0]]; ring >= 0) by_ring[ring].push_back(all[f]);
  auto row = [&](Cell ring, const DistortionSummary& s) {
    table.add({surface.name(), surface.size(), method, std::move(ring), known(s.median), known(s.mean),
               known(s.percentile_95), known(s.largest), known(s.flipped_area), s.unmeasured});
  };
  for (int r = 0; r < ring_count; ++r) row((r + 0.5) / ring_count, summary(by_ring[r]));
  row("all", summary(all));
}

void measure(const Surface& surface, Table& table) {
  const Index source = surface.size() / 2;
  const std::vector<int> ring_of = rings(surface.path_lengths(source), ring_count);
  if (surface.name() == "sphere") add(surface, ring_of, "exact", surface.sphere_log(source), table);
  for (const NamedMethod& method : log_map_methods())
    add(surface, ring_of, method.name, method.make(surface.graph())->solve(source).coordinates, table);
}

}  // namespace

Table distortion(const Settings& settings) {
  Table table({"shape", "vertices", "method", "distance / longest", "median D", "mean D", "95% D", "largest D",
               "flipped area", "unmeasured"});
  const Index n = settings.toy ? 600 : 20000;
  measure(Surface("flat grid", test::flat_square(settings.toy ? 25 : 141, 0.0)), table);
  measure(Surface("sphere", split_icosphere(n)), table);
  measure(Surface("ellipsoid", ellipsoid(n)), table);
  measure(Surface("bumpy sphere", bumpy_sphere(n)), table);
  measure(Surface("torus", torus(n)), table);
  for_user_surfaces(settings, 200000, [&](const Surface& surface) { measure(surface, table); });

  auto over_all = [&](std::string_view method, const char* column) {
    return quantile(table.where("method", method).where("distance / longest", "all").numbers(column), 0.5);
  };
  std::string found;
  for (const NamedMethod& method : log_map_methods())
    append(found, fmt::format("{} {:.2f} / {:.1f}", method.name, over_all(method.name, "median D"),
                              over_all(method.name, "95% D")));
  table.seen = fmt::format(
      "Median / 95 % of D, median of the shapes: {}. The exact log map of the sphere has {:.2f} / {:.1f}: less than "
      "that is no advantage.",
      found, over_all("exact", "median D"), over_all("exact", "95% D"));
  return table;
}

}  // namespace ahm::bench
