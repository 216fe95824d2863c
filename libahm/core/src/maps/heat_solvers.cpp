#include "maps/heat_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"
#include "maps/one_rings.hpp"

namespace ahm {
namespace {

/// Checks the options and the graph before the first member of `HeatGraph` reads the graph.
const TangentGraph& checked(const TangentGraph& graph, const HeatOptions& options) {
  check_heat_options(graph, options);
  return graph;
}

}  // namespace

HeatGraph::HeatGraph(const TangentGraph& graph, const HeatOptions& options)
    : graph(checked(graph, options)),
      options(options),
      strategy(choose_strategy({graph.size(), graph.dimension(), graph.transport_kind()}, options)),
      scales(graph),
      times(scales, options.t_coef),
      builder(graph, scales.components.of_vertex) {}

/// One-rings of the graph; null on graphs that are not triangulations. With strategy `march` they contain only the vertices that have
/// midpoints.
std::shared_ptr<const Wavefront::OneRings> HeatGraph::one_rings(unsigned threads) const {
  if (!graph.is_delaunay()) return nullptr;
  return one_rings_.get<Wavefront::OneRings>(GraphCache::Kind::one_rings_with_midpoints, [&] {
    if (strategy == Strategy::global) return Wavefront::one_rings(graph, threads);
    std::vector<std::uint8_t> halved = halved_vertices(scales.components.of_vertex, scales.sizes);
    return std::make_shared<const Wavefront::OneRings>(graph, std::move(halved), false, threads);
  });
}

FrontDistances HeatGraph::front(const Source& source, const MapSettings& map, unsigned threads) const {
  if (!map.distances || !unfolds(graph, source)) return {};
  Wavefront front(graph, one_rings(threads), map.spread && graph.is_delaunay());
  front.add(source);
  front.run(map.radius, map.progress.stop);
  const auto n = static_cast<std::size_t>(graph.size());
  FrontDistances result;
  result.distances.resize(n);
  result.directions.resize(front.has_directions() ? 2 * n : 0);
  result.direction_errors.reserve(front.has_directions() ? n : 0);
  result.nearest.resize(source.is_curve() ? n : 0);
  for (std::size_t i = 0; i < n; ++i) {
    result.distances[i] = front.distance(Vertex(i));
    if (!result.nearest.empty()) result.nearest[i] = front.nearest(Vertex(i));
    if (result.directions.empty()) continue;
    std::ranges::copy(front.direction(Vertex(i)), result.directions.begin() + 2 * i);
    result.direction_errors.push_back(front.direction_error(Vertex(i)));
  }
  return result;
}

March MarchSolver::march(const MapSettings& map, const FrontDistances* front, unsigned threads) const {
  const KnownDistances* known = front && !front->distances.empty() ? front : nullptr;
  return March(heat_graph_.graph, heat_graph_.options, heat_graph_.times, map.variant, {map.radius, known}, threads,
               map.progress, nullptr, nullptr, map.goal());
}

LogMap MarchSolver::solve(const Source& source, const MapSettings& map, unsigned threads) const {
  FrontDistances front;
  const auto unfold = [&] { front = heat_graph_.front(source, map, threads); };
  const bool ends = std::isfinite(map.radius);  // distances determine where the march ends, so the front comes first
  if (ends) unfold();
  March march = this->march(map, ends ? &front : nullptr, threads);
  if (ends)
    march.run(source);
  else
    detail::run_both(
        threads, [&] { march.run(source); }, unfold);
  return heat_graph_.builder.build(march, source, front, map, threads);
}

LogMap MarchSolver::continue_from(AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
                                  const MapSettings& map, unsigned threads) const {
  if (map.goal() == MarchGoal::map) {
    if (!heat.has_squares()) heat.solve_squares();
    if (!heat.has_lengths() && !heat_graph_.graph.is_delaunay()) heat.solve_lengths();
  }
  March march = this->march(map, &front, threads);
  march.run_on(heat, s, source);
  return heat_graph_.builder.build(march, source, front, map, threads);
}

const HeatOperators& GlobalSolver::operators(const Progress& progress) const {
  std::call_once(once_, [&] {
    const HeatGraph& heat = heat_graph_;
    detail::with_memory_check("factoring a graph of " + detail::counted(heat.graph.size(), "vertex"), [&] {
      HeatOptions quiet = heat.options;
      quiet.progress = progress;
      operators_ = HeatOperatorsAccess::make(
          factored_system(heat.graph, diffusion_times(heat.scales, heat.options.t_coef), quiet.factor()), heat.graph,
          heat.scales.components);
    });
  });
  return *operators_;
}

std::vector<LogMap> GlobalSolver::solve(std::span<const Source> sources, const MapSettings& map,
                                        unsigned threads) const {
  const TangentGraph& graph = heat_graph_.graph;
  AffineHeat heat(graph, operators(), map.variant, right_hand_side_of(sources, graph, operators(), map.variant),
                  threads);
  const bool lengths = map.distances && std::ranges::any_of(sources, [&](auto& one) { return !unfolds(graph, one); });
  const bool squares = lengths || map.spread;
  std::vector<FrontDistances> fronts;  // one per source
  const auto unfold = [&] {
    for (const Source& source : sources) fronts.push_back(heat_graph_.front(source, map, threads));
  };
  const auto solve = [&] {
    heat.diffuse();
    if (map.progress.stop.stop_requested()) throw Cancelled("cancelled during solve");
    heat.solve();
    if (squares) heat.solve_squares();
    if (lengths) heat.solve_lengths();
  };
  detail::run_both(threads, solve, unfold);
  std::vector<LogMap> maps;
  for (std::size_t s = 0; s < sources.size(); ++s) maps.push_back(build(heat, s, sources[s], fronts[s], map, threads));
  return maps;
}

LogMap GlobalSolver::build(AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
                           const MapSettings& map, unsigned threads) const {
  LogMap result = heat_graph_.builder.build(heat, s, source, front, map, threads);
  if (heat_graph_.options.strategy != Strategy::automatic || result.count(Status::unreached) == 0) return result;
  return MarchSolver(heat_graph_).continue_from(heat, s, source, front, map, threads);
}

}  // namespace ahm
