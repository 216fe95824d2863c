// Fig. 4: a spherical cap of 60 degrees. It is convex, so its geodesics are those of the sphere.
#include <fmt/format.h>

#include <cmath>

#include "experiments/comparison.hpp"
#include "methods/signed_heat.hpp"

namespace ahm::bench {
namespace {

constexpr NamedMethod methods[] = {
    {"AHM_a", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::adaptive); }},
    {"AHM_l", [](const TangentGraph& g) { return methods::affine_heat(g, Variant::localized); }},
    {"VHM_log", [](const TangentGraph& g) { return methods::vector_heat_log(g); }},
    {"SEM", [](const TangentGraph& g) { return methods::smoothed_exponential(g); }},
    {"HM (graph)", [](const TangentGraph& g) { return methods::heat_distance(g); }},
    {"SHM", [](const TangentGraph& g) -> methods::Method { return std::make_unique<methods::SignedHeat>(g); }}};

}  // namespace

Table boundary(const Settings& settings) {
  Table table({"source", "vertices", "method", "part", "distance rms", "map rms", "distance rms / h"});
  const int parallels = settings.toy ? 15 : 60, meridians = 2 * parallels;
  const double rim = std::numbers::pi / 3;
  const Surface cap("cap", parallels_and_meridians(parallels, meridians, rim));
  for (const auto& [where, polar] :
       {std::pair{"middle", 0.0}, {"off the middle", rim / 2}, {"near the rim", 0.9 * rim}}) {
    const Index source = cap.nearest({std::sin(polar), 0, std::cos(polar)});
    const std::vector<double> exact = cap.sphere_log(source), distance = lengths(exact);
    for (const NamedMethod& method : methods) {
      const methods::Result result = method.make(cap.graph())->solve(source);
      for (const bool on_rim : {false, true}) {
        auto chosen = [&](std::size_t i) { return (i + meridians >= distance.size()) == on_rim; };
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < distance.size(); ++i)
          if (chosen(i)) sum += std::pow(result.distance[i] - distance[i], 2), count += 1;
        table.add({where, cap.size(), method.name, on_rim ? "rim" : "inside", std::sqrt(sum / count),
                   result.coordinates.empty() ? Cell() : Cell(errors(result.coordinates, exact, chosen).rms),
                   std::sqrt(sum / count) / cap.mean_edge()});
      }
    }
  }
  auto rms = [&](const char* method, const char* part) {
    return table.where("method", method).where("part", part).mean("distance rms");
  };
  table.seen = fmt::format(
      "Error of the distance inside / on the rim, mean of the sources: AHM_a {:.4f} / {:.4f}, AHM_l {:.4f} / {:.4f}, "
      "SHM {:.4f} / {:.4f}, HM {:.4f} / {:.4f}.",
      rms("AHM_a", "inside"), rms("AHM_a", "rim"), rms("AHM_l", "inside"), rms("AHM_l", "rim"), rms("SHM", "inside"),
      rms("SHM", "rim"), rms("HM (graph)", "inside"), rms("HM (graph)", "rim"));
  return table;
}

}  // namespace ahm::bench
