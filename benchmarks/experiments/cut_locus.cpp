// Fig. 12: a tube. Geodesics around its two sides meet on a line opposite to the source.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/comparison.hpp"

namespace ahm::bench {
namespace {

constexpr double radius = 0.2;
constexpr int edges_shown = 24;

/// Unit vector towards a neighbor in the frame of a vertex.
std::array<double, 2> towards(const TangentGraph& graph, Index vertex, Index neighbor) {
  const Star star = graph.star(vertex);
  const auto found = std::ranges::find(star.neighbors, neighbor);
  const auto log = star.log(static_cast<std::size_t>(found - star.neighbors.begin()));
  const double length = std::hypot(log[0], log[1]);
  return {log[0] / length, log[1] / length};
}

/// The tube unrolled about the source, and the number of edges from each vertex to the cut line, around the tube. A tube of
/// flat quads is flat, so this is exact.
struct UnrolledTube {
  UnrolledTube(const Surface& surface, int around, Index source) {
    const auto round = towards(surface.graph(), source, source + 1),
               along = towards(surface.graph(), source, source + around);
    const double side = 2 * radius * std::sin(std::numbers::pi / around);
    for (Index i = 0; i < surface.size(); ++i) {
      Index step = (i - source) % around;  // vertices are numbered around the tube
      if (step < 0) step += around;
      if (step > around / 2) step -= around;
      from_cut.push_back(around / 2 - std::abs(step));
      const double x = surface.points()[i][0] - surface.points()[source][0];
      for (std::size_t a = 0; a < 2; ++a) log.push_back(x * along[a] + step * side * round[a]);
    }
  }
  std::vector<double> log;
  std::vector<Index> from_cut;
};

/// Share of the edges that the map stretches by more than a factor of 2.
double torn_share(const Surface& surface, std::span<const double> map) {
  Offset torn = 0, edges = 0;
  for (Index i = 0; i < surface.size(); ++i) {
    const Star star = surface.graph().star(i);
    for (std::size_t e = 0; e < star.degree(); ++e, ++edges) {
      const Index j = star.neighbors[e];
      const double step = std::hypot(map[2 * j] - map[2 * i], map[2 * j + 1] - map[2 * i + 1]);
      torn += step > 2 * surface.graph().length_unit() * std::hypot(star.log(e)[0], star.log(e)[1]);
    }
  }
  return static_cast<double>(torn) / static_cast<double>(edges);
}

void measure(int around, Table& table) {
  const Surface surface("tube", tube(around, radius));
  const Index source = surface.size() / around / 2 * around;
  const UnrolledTube exact(surface, around, source);
  for (const NamedMethod& method : log_map_methods()) {
    const auto map = method.make(surface.graph())->solve(source).coordinates;
    const double torn = torn_share(surface, map);
    for (Index edges = 0; edges <= std::min(edges_shown, around / 2); ++edges) {
      const Errors e = errors(map, exact.log, [&](std::size_t i) { return exact.from_cut[i] == edges; });
      table.add({surface.size(), around, method.name, edges, e.mean / radius, e.largest / radius, torn});
    }
  }
}

}  // namespace

Table cut_locus(const Settings& settings) {
  Table table({"vertices", "around", "method", "edges from cut", "mean / radius", "largest / radius", "torn edges"});
  for (int around : settings.toy ? std::vector{16, 32} : std::vector{32, 64, 128}) measure(around, table);
  const Table finest = table.where("around", settings.toy ? "32" : "128").where("method", "AHM_a");
  auto at = [&](const char* edges) { return finest.where("edges from cut", edges).mean("mean / radius"); };
  table.seen = fmt::format(
      "On the cut line the error of AHM_a is {:.2g} radii (it averages the two sides), {:.2g} of it four, {:.2g} eight "
      "and "
      "{:.2g} twelve edges away; it tears {:.1f} % of the edges.",
      at("0"), at("4") / at("0"), at("8") / at("0"), at("12") / at("0"), 100 * finest.mean("torn edges"));
  return table;
}

}  // namespace ahm::bench
