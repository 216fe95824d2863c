#include "maps/map_work.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "heat/cholesky.hpp"
#include "maps/march_depth.hpp"

namespace ahm {
namespace {

/// How much longer ways along edges are than straight ones, where these do not run along edges.
constexpr double detour = 1.1;

constexpr double unreached = std::numeric_limits<double>::infinity();

/// The least sum of a length along edges from the source; `unreached` where there is no way, or none up to `farthest`.
/// @param length_of  of an edge, from its star's vertex
template <class LengthOf>
std::vector<double> ways_from(const Source& source, const TangentGraph& graph, double farthest,
                              const LengthOf& length_of) {
  std::vector<double> known(static_cast<std::size_t>(graph.size()), unreached);
  ShortestPaths<double, std::vector<double>> paths(known, unreached);
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) paths.offer(source.vertices()[k].index, 0);
  paths.run([&](Index i, double so_far) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0)
        if (const double way = so_far + length_of(i, star, e); way <= farthest) paths.offer(star.neighbors[e], way);
  });
  return known;
}

}  // namespace

SystemSize system_size(const TangentGraph& graph, std::span<const Index> vertices, const HeatOptions& options) {
  std::vector<Index> place(static_cast<std::size_t>(graph.size()), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) place[vertices[k]] = static_cast<Index>(k);
  SystemSize size{.vertices = static_cast<double>(vertices.size())};
  SparseUpper pattern;
  pattern.column_begin.push_back(0);
  std::vector<Index> above;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Star star = graph.star(vertices[k]);
    above.clear();
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = place[star.neighbors[e]];
      if (j < 0 || star.weights[e] == 0) continue;
      size.edges += 1;
      if (j < static_cast<Index>(k)) above.push_back(j);
    }
    std::sort(above.begin(), above.end());
    above.erase(std::unique(above.begin(), above.end()), above.end());
    pattern.rows.insert(pattern.rows.end(), above.begin(), above.end());
    pattern.rows.push_back(static_cast<Offset>(k));
    pattern.column_begin.push_back(static_cast<Offset>(pattern.rows.size()));
  }
  const SymbolicCholesky analysis(pattern, options.ordering);
  size.nonzeros = static_cast<double>(analysis.nonzeros());
  size.operations = analysis.operations();
  return size;
}

SystemSize system_size(const TangentGraph& graph, const HeatOptions& options) {
  std::vector<Index> all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  return system_size(graph, all, options);
}

MarchWork march_work(const TangentGraph& graph, const Source& source, const MarchScales& scales, double radius,
                     const HeatOptions& options) {
  const auto heat_way = [&](Index i, const Star& star, std::size_t e) {
    const double tau = scales.tau(i);
    return std::max(0.0, edge_heat_distance(length(star.log(e)), star.weights[e], tau, std::sqrt(tau),
                                            [&] { return heat_diagonal(graph, i, tau); }));
  };
  const std::vector<double> levels = ways_from(source, graph, std::numeric_limits<double>::max(), heat_way);
  double last = 0, farthest = 0;  // where the march ends, and the graph
  for (double level : levels)
    if (level < unreached) farthest = std::max(farthest, level);
  if (std::isinf(radius)) {
    last = farthest;
  } else {
    const Index start = source.vertices()[0].index;
    const double reach = detour * (radius / graph.length_unit() + 4 * scales.h(start));
    const auto ways =
        ways_from(source, graph, reach, [](Index, const Star& star, std::size_t e) { return length(star.log(e)); });
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i] < unreached) last = std::max(last, levels[i]);
  }

  MarchWork work;
  std::vector<double> sorted;
  for (double level : levels)
    if (level < unreached) sorted.push_back(level);
  std::sort(sorted.begin(), sorted.end());
  const auto count_to = [&](double level) {
    return static_cast<double>(std::upper_bound(sorted.begin(), sorted.end(), level) - sorted.begin());
  };
  const double margin = march_margin(options.accuracy), depth = march_step + margin, step = depth / detour - margin;
  double largest_from = 0;
  for (double from = 0; from <= last; from += step) {
    const double ahead = count_to(from + depth), size = ahead - (from > 0 ? count_to(from) : 0);
    ++work.bands;
    work.solved += size;
    work.reached = ahead;
    if (size > work.largest.vertices) work.largest.vertices = size, largest_from = from;
    if (from + depth >= farthest) break;  // all that is ahead was in it
  }
  std::vector<Index> band;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if ((levels[i] > largest_from || largest_from == 0) && levels[i] <= largest_from + depth)
      band.push_back(static_cast<Index>(i));
  work.largest = system_size(graph, band, options);
  return work;
}

}  // namespace ahm
