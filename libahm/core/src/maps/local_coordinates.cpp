#include "ahm/maps/local_coordinates.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/ball.hpp"
#include "maps/patch_maps.hpp"
#include "maps/right_hand_side.hpp"
#include "maps/source_vertices.hpp"

namespace ahm {
namespace {

using Regions = std::span<const std::span<const Vertex>>;

void check(const TangentGraph& graph, std::span<const Source> sources, Regions regions, const HeatOptions& heat,
           double margin) {
  if (regions.size() != sources.size())
    throw InvalidArgument("there are " + std::to_string(regions.size()) + " regions, of " +
                          std::to_string(sources.size()) + " sources");
  check_patches(graph, sources, heat, margin);
  for (const auto region : regions)
    for (const auto [vertex] : region)
      if (vertex < 0 || vertex >= graph.size())
        throw InvalidArgument("vertex " + std::to_string(vertex) + " is outside [0, " + std::to_string(graph.size()) +
                              ")");
}

/// How far along edges (graph units) the farthest vertex of its region is from every source.
std::vector<double> extents(const TangentGraph& graph, const ComponentScales& scales, std::span<const Source> sources,
                            Regions regions) {
  std::vector<double> result(sources.size(), 0);
  Ball ball(graph);
  std::vector<std::uint8_t> wanted(static_cast<std::size_t>(graph.size()), 0);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SourceComponents components(sources[s], scales.components.of_vertex);
    std::size_t left = 0;
    for (const auto [vertex] : regions[s])
      if (components.hold(vertex) && wanted[vertex] == 0) wanted[vertex] = 1, ++left;
    ball.grow(sources[s].vertices(), std::numeric_limits<double>::infinity(), [&](Index vertex, double distance) {
      if (wanted[vertex] != 0) result[s] = distance, wanted[vertex] = 0, --left;
      return left > 0;
    });
    for (const auto [vertex] : regions[s]) wanted[vertex] = 0;
  }
  return result;
}

}  // namespace

std::vector<double> local_coordinates(const TangentGraph& graph, std::span<const Source> sources, Regions regions,
                                      const HeatOptions& heat, double margin) {
  return detail::with_memory_check("solving for local coordinates", [&] {
    check(graph, sources, regions, heat, margin);
    const ComponentScales scales(graph);
    const auto d = static_cast<std::size_t>(graph.dimension());
    std::vector<std::size_t> begin{0};
    for (const auto region : regions) begin.push_back(begin.back() + region.size());
    std::vector<double> result(begin.back() * d, std::numeric_limits<double>::quiet_NaN());

    const std::vector<double> extent = extents(graph, scales, sources, regions);
    const auto groups = patch_groups(graph, scales, sources, extent, heat, margin);
    const auto solve = [&](PatchSolver& patches, std::span<const Index> members) {
      std::vector<Source> group;
      double farthest = 0;
      for (Index s : members) group.push_back(sources[s]), farthest = std::max(farthest, extent[s]);
      const auto patch = patches.solve(patches.cut(group, farthest + margin * patches.sqrt_tau(group)));
      for (std::size_t m = 0; m < members.size(); ++m) {
        const SourceVertices own(patch->sources[m], graph.dimension());
        double* phi = result.data() + begin[members[m]] * d;
        for (const auto [vertex] : regions[members[m]]) {
          const auto found = std::ranges::lower_bound(patch->vertices, vertex);
          const auto place = static_cast<Index>(found - patch->vertices.begin());
          if (found != patch->vertices.end() && *found == vertex && patch->heat->reached(m, place)) {
            patch->heat->coordinates_at(m, place, phi);
            if (const auto* known = own.find(place)) std::copy(known->vector.begin(), known->vector.end(), phi);
            if (!all_finite(std::span(phi, d))) std::fill_n(phi, d, std::numeric_limits<double>::quiet_NaN());
          }
          phi += d;
        }
      }
    };
    share_groups(
        groups, heat.threads, heat.progress, [&] { return std::make_unique<PatchSolver>(graph, scales, heat); }, solve);
    return result;
  });
}

}  // namespace ahm
