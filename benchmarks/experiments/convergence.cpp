// Fig. 24: convergence to the closed form on the unit sphere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr NamedMethod methods[] = {
    {"AHM_a", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::adaptive); }},
    {"AHM_l", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::localized); }},
    {"VHM_log", [](const TangentGraph& g) { return methods::vector_heat_log(g); }},
    {"SEM", [](const TangentGraph& g) { return methods::smoothed_exponential(g); }}};

/// The norms of the paper, and L2 away from the cut locus; means over the sources.
struct Norms {
  double whole = 0, inside = 0, hemisphere = 0;
};

Norms norms(const Surface& surface, const methods::Baseline& method) {
  constexpr int source_count = 3;
  Norms mean;
  for (int s = 0; s < source_count; ++s) {
    const Index source = 7 + s * (surface.size() / source_count);
    const auto map = method.solve(source).coordinates;
    const std::vector<double> exact = surface.sphere_log(source), distance = lengths(exact);
    double whole = 0, inside = 0, largest = 0, mass = 0, inside_mass = 0;
    for (Index i = 0; i < surface.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double e = std::hypot(map[2 * k] - exact[2 * k], map[2 * k + 1] - exact[2 * k + 1]);
      const double m = surface.graph().mass(i);
      whole += m * e * e, mass += m;
      if (distance[k] < 0.85 * std::numbers::pi) inside += m * e * e, inside_mass += m;
      if (distance[k] < std::numbers::pi / 2) largest = std::max(largest, e);
    }
    mean.whole += std::sqrt(whole / mass) / source_count;
    mean.inside += std::sqrt(inside / inside_mass) / source_count;
    mean.hemisphere += largest / source_count;
  }
  return mean;
}

void measure(const char* shape, const std::vector<Surface>& surfaces, const NamedMethod& method, Table& table) {
  std::vector<double> h, whole, inside, hemisphere;
  for (const Surface& surface : surfaces) {
    const Norms e = norms(surface, *method.make(surface.graph()));
    h.push_back(surface.mean_edge());
    whole.push_back(e.whole), inside.push_back(e.inside), hemisphere.push_back(e.hemisphere);
  }
  for (std::size_t k = 0; k < h.size(); ++k)
    table.add({shape, surfaces[k].size(), method.name, h[k], whole[k], inside[k], hemisphere[k], fitted_order(h, whole),
               fitted_order(h, inside), fitted_order(h, hemisphere)});
}

}  // namespace

Table convergence(const Settings& settings) {
  Table table({"mesh", "vertices", "method", "h", "L2", "L2 inside", "Linf hemisphere", "order L2", "order L2 inside",
               "order Linf"});
  std::vector<Surface> smooth, jittered;
  for (Index n = 642; n <= (settings.toy ? 2562 : 163842); n = 4 * n - 6) {
    smooth.emplace_back("icosphere", split_icosphere(n));
    jittered.emplace_back("jittered", jittered_icosphere(n, 0.15));
  }
  for (const NamedMethod& method : methods) {
    measure("icosphere", smooth, method, table);
    measure("jittered", jittered, method, table);
  }
  std::string orders;
  for (const NamedMethod& method : methods) {
    const Table rows = table.where("mesh", "icosphere").where("method", method.name);
    append(orders, fmt::format("{} {:.2f} / {:.2f} / {:.2f}", method.name, rows.mean("order L2"),
                               rows.mean("order L2 inside"), rows.mean("order Linf")));
  }
  table.seen =
      "Fitted orders on icospheres, L2 whole / L2 within 0.85 pi / L-infinity on the hemisphere: " + orders + ".";
  return table;
}

}  // namespace ahm::bench
