// Flat graphs far beyond the reach of one solve, by march, compared with the closed form: a tube of 40 vertices around, and
// a cube of voxels.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/small_math.hpp"
#include "scaling/sizes.hpp"

namespace ahm::bench {
namespace {

constexpr Index around = 40;

struct MarchResult {
  LogMap map;
  double time;
};

MarchResult march_from(const TangentGraph& graph, Vertex source, const Settings& settings) {
  const LogMapSolver solver(graph, {.strategy = Strategy::march, .check_graph = false, .threads = settings.threads});
  std::optional<LogMap> map;
  const double time = seconds([&] { map.emplace(solver.solve(Source::at_vertex(source), {.spread = false})); });
  return {std::move(*map), time};
}

std::vector<double> row(const MarchResult& marched, double distance, double on_line, double elsewhere) {
  return {static_cast<double>(marched.map.size()),
          marched.time,
          static_cast<double>(marched.map.march().bands),
          peak_megabytes(),
          static_cast<double>(marched.map.count(Status::ok)),
          distance,
          on_line,
          elsewhere};
}

/// Relative errors of the tube from ring `near` on: 1 % of its length, at most 100 rings.
std::vector<double> tube(Index n, const Settings& settings) {
  const Index rings = std::max<Index>(n / around, 2), near = std::min<Index>(100, rings / 100 + 2);
  const CsrGraph graph(test::tube(rings, around));
  const MarchResult marched = march_from(graph, Vertex(0), settings);
  double distance = 0, on_line = 0, elsewhere = 0;
  for (Index ring = near; ring < rings; ++ring)
    for (Index k = 0; k < around; ++k) {
      const Vertex v(ring * around + k);
      const double exact = std::hypot(ring, std::min(k, around - k));
      const auto relative = [&](double found) { return std::abs(found - exact) / exact; };
      double& length_error = k == 0 ? on_line : elsewhere;
      length_error = std::max(length_error, relative(length(marched.map.coordinates(v))));
      distance = std::max(distance, relative(marched.map.distance(v)));
    }
  return row(marched, distance, on_line, elsewhere);
}

/// Largest errors of the cube over its diameter. Errors of vectors are in both columns of lengths.
std::vector<double> cube(Index n, const Settings& settings) {
  const auto side = static_cast<Index>(std::lround(std::cbrt(n)));
  const grid::GridGraph graph({.shape = {side, side, side}, .spacing = {1, 1, 1}});
  const MarchResult marched = march_from(graph, Vertex(0), settings);
  double distance = 0, vector = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    const std::array<double, 3> exact{static_cast<double>(i % side), static_cast<double>(i / side % side),
                                      static_cast<double>(i / side / side)};
    const auto phi = marched.map.coordinates(Vertex(i));
    for (std::size_t a = 0; a < 3; ++a) vector = std::max(vector, std::abs(phi[a] - exact[a]));
    distance = std::max(distance, std::abs(marched.map.distance(Vertex(i)) - length(exact)));
  }
  const double diameter = std::sqrt(3.0) * (side - 1);
  return row(marched, distance / diameter, vector / diameter, vector / diameter);
}

}  // namespace

Table far(const Settings& settings) {
  Table table({"shape", "vertices", "first map s", "bands", "peak MB", "ok", "distance", "|phi|, line of the source",
               "|phi| elsewhere"});
  for (const char* shape : {"tube", "cube"})
    for (Index n : sizes(settings, 8000, {40000, 1000000})) {
      std::vector<Cell> cells{shape};
      const bool is_tube = shape == std::string_view("tube");
      for (double number : in_own_process(8, [&] { return is_tube ? tube(n, settings) : cube(n, settings); }))
        cells.push_back(number);
      table.add(cells);
    }
  table.seen = fmt::format(
      "Along the line of the source |phi| is exact to {:.1g} on tubes, and vectors to {:.1g} of the diameter in cubes.",
      table.where("shape", "tube").largest("|phi|, line of the source"),
      table.where("shape", "cube").largest("|phi| elsewhere"));
  return table;
}

}  // namespace ahm::bench
