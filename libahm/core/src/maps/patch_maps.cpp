#include "maps/patch_maps.hpp"

#include <cmath>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "graph/patch.hpp"

namespace ahm {
namespace {

/// Largest number of sources that share a patch. Chosen by measurement: more sources make patches larger, fewer sources need more
/// factorizations.
constexpr std::size_t group_size = 48;

}  // namespace

std::vector<std::vector<Index>> groups_of(const TangentGraph& graph, std::span<const Source> sources,
                                          const std::function<double(Index seed)>& reach) {
  const auto n = static_cast<std::size_t>(graph.size());
  SparseArray<Index> first(n);  // 1 + the first source at a vertex that has no group yet
  std::vector<Index> after(sources.size(), -1);
  for (auto s = static_cast<Index>(sources.size()); s-- > 0;) {
    Index& head = first[sources[s].vertices().front().index];
    after[s] = head - 1;
    head = s + 1;
  }
  std::vector<std::uint8_t> grouped(sources.size(), 0);
  std::vector<std::vector<Index>> groups;
  Ball ball(graph);
  for (std::size_t seed = 0; seed < sources.size(); ++seed) {
    if (grouped[seed]) continue;
    std::vector<Index> members;
    ball.grow(sources[seed].vertices().first(1), reach(static_cast<Index>(seed)), [&](Index vertex, double) {
      for (Index s = first[vertex] - 1; s >= 0; s = first[vertex] - 1) {
        if (members.size() == group_size) return false;
        members.push_back(s);
        grouped[s] = 1;
        first[vertex] = after[s] + 1;
      }
      return members.size() < group_size;
    });
    groups.push_back(std::move(members));
  }
  return groups;
}

void check_patches(const TangentGraph& graph, std::span<const Source> sources, const DiffusionOptions& options,
                   double margin) {
  if (!(margin >= 0) || !std::isfinite(margin))
    throw InvalidArgument("margin is " + detail::number(margin) + "; it must be finite and >= 0");
  check_diffusion(graph, options.factor());
  for (const Source& source : sources) check_source(source, graph);
}

std::vector<std::vector<Index>> patch_groups(const TangentGraph& graph, const ComponentScales& scales,
                                             std::span<const Source> sources, std::span<const double> extent,
                                             const DiffusionOptions& options, double margin) {
  return groups_of(graph, sources, [&](Index seed) {
    return extent[seed] + (margin + 4) * std::sqrt(options.t_coef) * scales.h(sources[seed].vertices().front().index);
  });
}

PatchSolver::PatchSolver(const TangentGraph& graph, const ComponentScales& scales, const DiffusionOptions& options)
    : graph_(graph), scales_(scales), options_(options), ball_(graph), place_(static_cast<std::size_t>(graph.size())) {
  options_.progress = {};
  options_.check_graph = false;
  options_.threads = 1;
}

double PatchSolver::sqrt_tau(std::span<const Source> sources) const {
  double h = 0;
  for (const Source& source : sources)
    for (Vertex vertex : source.vertices()) h = std::max(h, scales_.h(vertex.index));
  return std::sqrt(options_.t_coef) * h;
}

Patch PatchSolver::cut(std::span<const Source> sources, double limit) {
  std::vector<Vertex> starts;
  for (const Source& source : sources) starts.insert(starts.end(), source.vertices().begin(), source.vertices().end());
  std::vector<Index> vertices, edge;
  ball_.grow(starts, limit, [&](Index vertex, double) {
    vertices.push_back(vertex);
    return true;
  });
  // Sorted, so that the patch does not depend on the order of the search, and its matrix has nearly the ordering of the graph's.
  std::sort(vertices.begin(), vertices.end());
  for (std::size_t k = 0; k < vertices.size(); ++k) place_[vertices[k]] = static_cast<Index>(k) + 1;
  CsrGraph cut = cut_out(
      graph_, vertices, [&](Index j) { return place_[j] - 1; },
      [&](std::size_t k, const Star&, std::size_t) {
        if (edge.empty() || edge.back() != static_cast<Index>(k)) edge.push_back(static_cast<Index>(k));
        return 0.0;
      });
  std::vector<Source> inside;
  for (const Source& source : sources)
    inside.push_back(source.renumbered([&](Vertex v) { return Vertex(place_[v.index] - 1); }));
  for (Index vertex : vertices) place_[vertex] = 0;
  return {std::move(vertices), std::move(edge), std::move(cut), std::move(inside)};
}

std::unique_ptr<PatchMaps> PatchSolver::solve(Patch patch) const {
  std::vector<double> tau;
  for (Index vertex : patch.vertices) tau.push_back(diffusion_time(options_.t_coef, scales_.h(vertex)));
  auto maps = std::make_unique<PatchMaps>(std::move(patch), std::move(tau), options_);
  maps->heat.emplace(maps->graph, maps->operators, options_.variant,
                     right_hand_side_of(maps->sources, maps->graph, maps->operators, options_.variant));
  maps->heat->diffuse();
  maps->heat->solve();
  return maps;
}

}  // namespace ahm
