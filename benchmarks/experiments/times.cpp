// Fig. 13: errors for diffusion times over orders of magnitude.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ahm/conformance/triangle_meshes.hpp"
#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

struct TimedMethod {
  const char* name;
  methods::Method (*make)(const TangentGraph&, double t_coef);
};
constexpr TimedMethod methods[] = {
    {"AHM_a", [](const TangentGraph& g, double t) { return methods::affine_heat(g, Variant::adaptive, t); }},
    {"AHM_l", [](const TangentGraph& g, double t) { return methods::affine_heat(g, Variant::localized, t); }},
    {"VHM_log", [](const TangentGraph& g, double t) { return methods::vector_heat_log(g, {.t_coef = t}); }},
    {"SEM", [](const TangentGraph& g, double t) { return methods::smoothed_exponential(g, t); }}};

/// @param exact  log map, n x 2; empty where it is unknown
void measure(const Surface& surface, Index source, std::span<const double> exact, std::span<const double> distance,
             double within, Table& table) {
  for (double t_coef : {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0})
    for (const TimedMethod& method : methods) {
      const methods::Result found = method.make(surface.graph(), t_coef)->solve(source);
      const Errors e = errors(found.coordinates, exact, [&](std::size_t i) { return distance[i] <= within; });
      table.add({surface.name(), surface.size(), t_coef, method.name, exact.empty() ? Cell() : Cell(e.rms),
                 exact.empty() ? Cell() : Cell(e.largest), distance_rms(found.distance, distance, within), e.missing});
    }
}

void measure_known(const Surface& surface, Index source, std::span<const double> exact, double within, Table& table) {
  measure(surface, source, exact, lengths(exact), within, table);
}

}  // namespace

Table times(const Settings& settings) {
  Table table({"shape", "vertices", "t_coef", "method", "rms", "largest", "distance rms", "missing"});
  const Index n = settings.toy ? 600 : 10000;
  const Surface sphere("sphere", split_icosphere(n));
  const Index middle = sphere.size() / 3;
  measure_known(sphere, middle, sphere.sphere_log(middle), 0.85 * std::numbers::pi, table);  // away from the cut locus
#ifdef AHM_METHODS_CGAL
  const Surface bumpy("bumpy sphere", bumpy_sphere(n));
  const std::vector<double> exact = methods::exact_distance(bumpy.points(), bumpy.faces())->solve(middle).distance;
  measure(bumpy, middle, {}, exact, 0.75 * std::ranges::max(exact), table);
#endif
  const Mesh square = test::flat_square(settings.toy ? 21 : 101);
  const Surface plane("plane", square);
  const Index center = test::nearest(square, {0.5, 0.5});
  measure_known(plane, center, plane.plane_log(center), 1.0, table);
  auto worst = [&](const char* method) {
    return table.where("method", method).where("shape", "sphere").largest("rms");
  };
  table.seen = fmt::format(
      "On the sphere the worst root mean square error over five orders of magnitude is {:.2g} for AHM_a, {:.2g} for "
      "AHM_l, {:.2g} for VHM_log and {:.2g} for SEM; in the plane AHM does not depend on the time.",
      worst("AHM_a"), worst("AHM_l"), worst("VHM_log"), worst("SEM"));
  return table;
}

}  // namespace ahm::bench
