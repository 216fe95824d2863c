#include "second_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "map_writer.hpp"

namespace ahm::distributed {
namespace {

/// Of the source's components; 0 for others, which no heat comes to.
std::vector<Index> component_sizes(const TiledGraph& graph, const Source& source, MarchTeam& team,
                                   const TileOwners& owners) {
  std::set<Index> components;
  for (const Vertex vertex : source.vertices()) components.insert(graph.component(vertex.index));
  std::vector<Index> sizes(graph.component_edge_lengths().size(), 0);
  for (std::size_t t = 0; t < graph.tiles(); ++t)
    if (owners.owns(t))
      for (const Index component : graph.rows(t).component) ++sizes[component];
  for (std::size_t c = 0; c < sizes.size(); ++c)
    if (!components.contains(static_cast<Index>(c))) sizes[c] = 0;
  for (const Index c : components) sizes[c] = static_cast<Index>(team.sum(sizes[c]));
  return sizes;
}

/// Of one time, whose factor differs from component to component.
class TimeScales final : public MarchScales {
 public:
  TimeScales(const TiledGraph& graph, std::vector<double> tau) : graph_(graph), tau_(std::move(tau)) {}
  double tau(Index vertex) const override { return tau_[graph_.component(vertex)]; }
  double h(Index vertex) const override { return graph_.component_edge_length(vertex); }

 private:
  const TiledGraph& graph_;
  std::vector<double> tau_;
};

/// A row of a map's tile.
TimedRow row_of(const MapTile& tile, std::size_t i) {
  return {static_cast<Status>(tile.status[i]), std::span(tile.coordinates).subspan(2 * i, 2), tile.distance[i],
          tile.spread[i]};
}

}  // namespace

TiledTimes::TiledTimes(const TiledGraph& graph, const Source& source, const HeatOptions& heat, MarchTeam& team,
                       const TileOwners& owners)
    : graph_(graph), t_coef_(heat.t_coef), times_(2, graph.dimension(), component_sizes(graph, source, team, owners)) {}

double TiledTimes::radius_of_each(double radius) const {
  return times_.radius_of_each(radius, graph_.component_edge_lengths(), graph_.length_unit());
}

std::unique_ptr<const MarchScales> TiledTimes::scales(std::size_t k) const {
  std::vector<double> tau;
  for (const double h : graph_.component_edge_lengths()) {
    const auto component = static_cast<Index>(tau.size());
    tau.push_back(t_coef_ * times_.factor(k, component) * h * h);
  }
  return std::make_unique<const TimeScales>(graph_, std::move(tau));
}

CombinedRows TiledTimes::combine(const std::vector<std::filesystem::path>& of_times, const std::filesystem::path& paths,
                                 const std::filesystem::path& folder, double radius, const TileOwners& owners) const {
  CombinedRows result;
  for (std::size_t t = 0; t < graph_.tiles(); ++t) {
    if (!owners.owns(t)) continue;
    const auto tile_in = [&](const std::filesystem::path& from, MarchGoal goal) {
      return MapTile(Manifest::file(from, MapTile::kind, t), goal);
    };
    const MapTile first = tile_in(of_times.front(), MarchGoal::map),
                  middle = tile_in(of_times[of_times.size() - 2], MarchGoal::map),
                  last = tile_in(of_times.back(), MarchGoal::map);
    const std::size_t vertices = first.status.size();
    const bool unfolded = paths.empty();
    const MapTile ways = unfolded ? MapTile(0, MarchGoal::distances) : tile_in(paths, MarchGoal::distances);
    const auto component = graph_.rows(t).component;
    MapTile map(vertices, MarchGoal::map);
    map.error.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      const double h = graph_.component_edge_lengths()[component[i]] * graph_.length_unit();
      double path = unfolded ? 0 : ways.distance[i];
      if (std::isnan(path)) path = std::numeric_limits<double>::infinity();
      const ExtrapolatedRow row = extrapolate_row(
          {row_of(first, i), row_of(middle, i), row_of(last, i)}, {t_coef_, times_.middle(component[i]), h},
          {.unfolded = unfolded, .of_curve = false}, path, radius, std::span(map.coordinates).subspan(2 * i, 2));
      map.status[i] = static_cast<std::uint8_t>(row.status);
      map.distance[i] = row.distance;
      map.error[i] = row.error;
      if (row.status != Status::ok) continue;
      map.spread[i] = first.spread[i];
      ++result.ok;
      result.farthest = std::max(result.farthest, row.distance);
    }
    map.write(Manifest::file(folder, MapTile::kind, t));
  }
  return result;
}

}  // namespace ahm::distributed
