// Order 2 beside order 1 against exact maps: where extrapolation helps, and where phi is not smooth in sqrt(tau).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 3;

/// A saddle whose points crowd at two sides: x and y as squares.
Mesh graded(int side) {
  Mesh mesh;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = std::pow(static_cast<double>(i) / (side - 1), 2),
                   y = std::pow(static_cast<double>(j) / (side - 1), 2);
      mesh.positions.push_back({x, y, 0.3 * x * x - 0.2 * y * y});
    }
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      const int a = i * side + j, b = a + side;
      mesh.faces.push_back({a, b, a + 1});
      mesh.faces.push_back({a + 1, b, b + 1});
    }
  return mesh;
}

/// Sums of squared errors of vectors, relative ones at most 1: what lies across a cut locus does not outweigh the rest.
struct Sums {
  double all = 0, trusted = 0;
};

Sums squares(const LogMap& exact, const LogMap& map, const std::vector<double>& quality, double h) {
  Sums sums;
  for (Index i = 0; i < map.size(); ++i) {
    const Vertex v(i);
    if (map.status(v) != Status::ok || exact.status(v) != Status::ok) continue;
    const auto ours = map.coordinates(v), truth = exact.coordinates(v);
    const double off = std::min(std::hypot(ours[0] - truth[0], ours[1] - truth[1]), std::max(h, exact.distance(v)));
    sums.all += off * off;
    if (quality[i] >= trusted_quality) sums.trusted += off * off;
  }
  return sums;
}

void measure(const Surface& surface, Table& table) {
  const ExactGeodesics exact(surface.mesh());
  for (Variant variant : all_variants) {
    const LogMapSolver one(surface.graph(), {.variant = variant}),
        two(surface.graph(), {.variant = variant, .order = 2});
    Sums sums[2];
    double scale = 0;
    for (int s = 0; s < source_count; ++s) {
      const auto row = surface.mesh().rows().row(Vertex((2 * s + 1) * (surface.size() / 7)));
      if (!row) continue;
      const Source source = surface.mesh().source(*row).source;
      const LogMap truth = exact.log_map(*row), first = one.solve(source), second = two.solve(source);
      const std::vector<double> quality = map_quality(surface.graph(), first);
      const Sums by[] = {squares(truth, first, quality, surface.mean_edge()),
                         squares(truth, second, quality, surface.mean_edge())};
      for (int k = 0; k < 2; ++k) sums[k].all += by[k].all, sums[k].trusted += by[k].trusted;
      for (double d : truth.distances())
        if (d > 0) scale += d * d;
    }
    const auto gain = [](double a, double b) { return a > 0 ? Cell(std::sqrt(b / a)) : Cell(); };
    table.add({surface.name(), surface.size(), std::string(to_string(variant)), std::sqrt(sums[0].all / scale),
               gain(sums[0].all, sums[1].all), std::sqrt(sums[0].trusted / scale),
               gain(sums[0].trusted, sums[1].trusted)});
  }
}

}  // namespace

Table orders(const Settings& settings) {
  Table table({"mesh", "vertices", "variant", "error", "order 2 / 1", "trusted error", "trusted order 2 / 1"});
  for (double degrees : {150.0, 250.0, 320.0})
    for (int rings : settings.toy ? std::vector{20} : std::vector{50, 100})
      for (bool closed : {false, true}) {
        const double angle = degrees * std::numbers::pi / 180;
        measure(Surface(fmt::format("{}cone {:.0f}", closed ? "closed " : "", degrees),
                        closed ? closed_cone(angle, rings) : cone(angle, rings)),
                table);
      }
  measure(Surface("graded saddle", graded(settings.toy ? 25 : 120)), table);
  for (Index n : settings.toy ? std::vector<Index>{640} : std::vector<Index>{2500, 10000, 40000})
    measure(Surface("sphere", test::split_icosphere(n)), table);
  for (Index n : settings.toy ? std::vector<Index>{700} : std::vector<Index>{2500, 5000, 9000, 20000})
    measure(Surface("random sphere", sliver_sphere(n)), table);
  measure(Surface("torus", torus(settings.toy ? 640 : 20000)), table);
  for_user_surfaces(settings, 20000, [&](const Surface& surface) { measure(surface, table); });
  table.seen = fmt::format(
      "Root mean square errors of order 2 are {:.2f} to {:.2f} times those of order 1 over all vertices, in the median "
      "{:.2f}.",
      table.smallest("order 2 / 1"), table.largest("order 2 / 1"), quantile(table.numbers("order 2 / 1"), 0.5));
  return table;
}

}  // namespace ahm::bench
