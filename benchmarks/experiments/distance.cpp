// Fig. 20: distances compared with exact polyhedral ones, by distance from the source.
#include <fmt/format.h>

#include <cmath>

#include "ahm/error.hpp"
#include "experiments/comparison.hpp"
#include "methods/signed_heat.hpp"

namespace ahm::bench {
namespace {

#ifdef AHM_METHODS_CGAL

constexpr int ring_count = 10;

struct DistanceMethod {
  const char* name;
  methods::Method (*make)(const Surface&);
};
constexpr DistanceMethod methods[] = {
    {"AHM_a", [](const Surface& s) { return methods::affine_heat(s.graph(), Variant::adaptive); }},
    {"AHM_l", [](const Surface& s) { return methods::affine_heat(s.graph(), Variant::localized); }},
    {"unfolded", [](const Surface& s) { return methods::unfolded_distance(s.graph()); }},
    {"HM", [](const Surface& s) { return methods::heat_distance(s.mesh().mesh()); }},
    {"HM (graph)", [](const Surface& s) { return methods::heat_distance(s.graph()); }},
    {"SHM", [](const Surface& s) -> methods::Method { return std::make_unique<methods::SignedHeat>(s.graph()); }}};

/// Adds the mean and quantiles of errors as a row.
void add_row(const Surface& surface, const char* method, Cell where, const std::vector<double>& e, Table& table) {
  if (e.empty()) return;
  double mean = 0;
  for (double x : e) mean += x / static_cast<double>(e.size());
  table.add({surface.name(), surface.size(), method, std::move(where), mean, quantile(e, 0.5), quantile(e, 0.95),
             quantile(e, 1.0)});
}

/// Relative errors of one method in rings around three sources, and over all vertices.
void measure(const Surface& surface, const DistanceMethod& method, std::span<const Index> sources,
             std::span<const std::vector<double>> exact, Table& table) {
  const methods::Method prepared = method.make(surface);
  std::vector<std::vector<double>> by_ring(ring_count);
  std::vector<double> all;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const std::vector<double> distance = prepared->solve(sources[s]).distance;
    const std::vector<int> ring_of = rings(exact[s], ring_count);
    for (std::size_t i = 0; i < distance.size(); ++i)
      if (const double error = std::abs(distance[i] / exact[s][i] - 1);
          ring_of[i] >= 0 && exact[s][i] > 0 && std::isfinite(error))
        by_ring[ring_of[i]].push_back(error), all.push_back(error);
  }
  for (int r = 0; r < ring_count; ++r) add_row(surface, method.name, (r + 0.5) / ring_count, by_ring[r], table);
  add_row(surface, method.name, "all", all, table);
}

void measure(const Surface& surface, Table& table) {
  const Index n = surface.size(), sources[] = {n / 7, n / 2, 5 * n / 6};
  std::vector<std::vector<double>> exact;
  const auto geodesics = methods::exact_distance(surface.points(), surface.faces());
  for (Index source : sources) exact.push_back(geodesics->solve(source).distance);
  for (const DistanceMethod& method : methods) try {
      measure(surface, method, sources, exact, table);
    } catch (const InvalidGeometry&) {  // HM as published requires faces with area
      table.add({surface.name(), n, method.name, {}, {}, {}, {}, {}});
    }
}

#endif

}  // namespace

Table distance([[maybe_unused]] const Settings& settings) {
#ifdef AHM_METHODS_CGAL
  Table table({"shape", "vertices", "method", "distance / longest", "mean", "median", "95%", "largest"});
  const Index n = settings.toy ? 600 : 10000;
  measure(Surface("sphere", split_icosphere(n)), table);
  measure(Surface("bumpy sphere", bumpy_sphere(n)), table);
  measure(Surface("torus", torus(n)), table);
  for_user_surfaces(settings, 50000, [&](const Surface& surface) { measure(surface, table); });
  for (const DistanceMethod& method : methods) {
    auto at = [&](const char* ring) {
      return quantile(table.where("method", method.name).where("distance / longest", ring).numbers("median"), 0.5);
    };
    append(table.seen, fmt::format("{} {:.4f} / {:.4f} / {:.4f}", method.name, at("0.05"), at("0.15"), at("0.45")));
  }
  table.seen =
      "Relative error at 0.05 / 0.15 / 0.45 of the longest distance, median of the shapes: " + table.seen + ".";
  return table;
#else
  throw InvalidArgument("distance: built without CGAL, which computes the exact distances; install libcgal-dev");
#endif
}

}  // namespace ahm::bench
