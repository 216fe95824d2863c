// Fig. 25: discrete exponential maps far from the source, on spheres.
#include <fmt/format.h>

#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr int ring_count = 10;

using methods::FrameTurn;
constexpr NamedMethod methods[] = {
    {"AHM_a", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::adaptive); }},
    {"DEM", [](const TangentGraph& g) { return methods::discrete_exponential(g, {.turn = FrameTurn::in_space}); }},
    {"DEM, along the path", [](const TangentGraph& g) { return methods::discrete_exponential(g); }},
    {"DEM, averaged", [](const TangentGraph& g) {
       return methods::discrete_exponential(g, {.turn = FrameTurn::in_space, .upwind_average = true});
     }}};

}  // namespace

Table dem(const Settings& settings) {
  Table table({"vertices", "method", "distance / pi", "mean", "largest"});
  const std::vector<Index> sizes =
      settings.toy ? std::vector<Index>{642, 2562} : std::vector<Index>{2562, 10242, 40962};
  for (Index n : sizes) {
    const Surface sphere("sphere", jittered_icosphere(n, 0.15));
    const Index source = n / 3;
    const std::vector<double> exact = sphere.sphere_log(source), distance = lengths(exact);
    for (const NamedMethod& method : methods) {
      const auto map = method.make(sphere.graph())->solve(source).coordinates;
      for (int r = 0; r < ring_count; ++r) {
        const double from = r * std::numbers::pi / ring_count, to = (r + 1) * std::numbers::pi / ring_count;
        const Errors e = errors(map, exact, [&](std::size_t i) { return distance[i] > from && distance[i] <= to; });
        table.add({n, method.name, (r + 0.5) / ring_count, e.mean, e.largest});
      }
    }
  }
  auto at = [&](Index n, const char* method, const char* ring) {
    return table.where("vertices", std::to_string(n)).where("method", method).where("distance / pi", ring).mean("mean");
  };
  table.seen = fmt::format(
      "Mean error at 0.05 / 0.75 pi on {} vertices: DEM {:.3f} / {:.3f}, AHM_a {:.3f} / {:.3f}; on {} vertices: DEM "
      "{:.3f} / {:.3f}, AHM_a {:.3f} / {:.3f}.",
      sizes.front(), at(sizes.front(), "DEM", "0.05"), at(sizes.front(), "DEM", "0.75"),
      at(sizes.front(), "AHM_a", "0.05"), at(sizes.front(), "AHM_a", "0.75"), sizes.back(),
      at(sizes.back(), "DEM", "0.05"), at(sizes.back(), "DEM", "0.75"), at(sizes.back(), "AHM_a", "0.05"),
      at(sizes.back(), "AHM_a", "0.75"));
  return table;
}

}  // namespace ahm::bench
