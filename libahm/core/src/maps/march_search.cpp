#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/march.hpp"
#include "maps/march_depth.hpp"

namespace ahm {
namespace {

constexpr float far_away = std::numeric_limits<float>::infinity();

/// Heat distances end here: what lies farther ahead has no order among itself, and is still reached.
constexpr double farthest = 1e30;

}  // namespace

/// The vertices ahead of the front within `depth_` of heat distance, own ones in the order of the graph.
March::Band March::find_band(const Source* source) {
  Band band;
  band.vertices = search(source);
  // The graph's own order keeps neighbours close in memory; that of the distance scatters them all around the front.
  std::sort(band.vertices.begin(), band.vertices.end());
  band.own = band.vertices.size();
  band.halo = team_.share(band.vertices);
  for (const HaloVertex& next : band.halo) band.vertices.push_back(next.vertex);
  for (std::size_t k = 0; k < band.vertices.size(); ++k) {
    Way& way_to = way(band.vertices[k]);
    way_to.place = static_cast<Index>(k);
    way_to.tentative = far_away;
  }
  find_edge(band);
  return band;
}

/// Dijkstra's algorithm, the levels on the front being those of the heat that was found there: each member among its own
/// vertices, again as long as something comes from others. What is found does not depend on who owns what.
std::vector<Index> March::search(const Source* source) {
  Tentative tentative{*this};
  ShortestPaths<float, Tentative> paths(tentative, far_away);
  std::vector<Ahead> ahead;
  std::vector<Crossing> leaving;
  auto offer = [&](const Ahead& edge, double distance, double tau, double root_tau) {
    const double along = edge_heat_distance(edge.length, edge.weight, tau, root_tau,
                                            [&] { return heat_diagonal(graph_, edge.vertex, tau); });
    // Negative weights may ask for less than nothing, and for ever.
    paths.offer(edge.vertex, static_cast<float>(std::min(distance + (along < 0 ? 0 : along), farthest)));
  };
  auto spread = [&](Index from, double distance) {
    const Star star = graph_.star(from);
    ahead.clear();  // a copy: the star's life may end when another one is asked for
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0 && may_be_nearer(star.neighbors[e], distance))
        ahead.push_back({star.neighbors[e], star.weights[e], length(star.log(e))});
    const double tau = this->tau(from), root_tau = std::sqrt(tau);  // as at the edges' other ends
    for (const Ahead& edge : ahead)
      if (team_.owns(edge.vertex))
        offer(edge, distance, tau, root_tau);
      else
        leaving.push_back({edge.vertex, distance, edge.length, edge.weight});
  };
  auto cross = [&] {
    if (team_.sum(static_cast<std::int64_t>(leaving.size())) == 0) return false;
    for (const Crossing& edge : team_.cross(leaving)) {
      const double tau = this->tau(edge.vertex);
      offer({edge.vertex, edge.weight, edge.length}, edge.distance, tau, std::sqrt(tau));
    }
    leaving.clear();
    return true;
  };
  if (source) {
    for (std::size_t k = 0; k < source->vertices().size(); ++k)
      if (const Index vertex = source->vertices()[k].index; source->weights()[k] > 0 && team_.owns(vertex))
        paths.offer(vertex, 0);
  } else {
    double base = std::numeric_limits<double>::infinity();
    for (Index vertex : front_) base = std::min(base, known_.level(numbers_.find(vertex)));
    base = team_.least(base);
    for (Index vertex : front_)
      if (const double beyond = known_.level(numbers_.find(vertex)) - base; beyond <= depth_) spread(vertex, beyond);
  }
  cross();

  std::vector<Index> found, touched;
  const double limit = team_.least(paths.empty() ? far_away : paths.least()) + depth_;
  do
    paths.run([&](Index vertex, float distance) {
      if (distance > limit) return touched.push_back(vertex);
      if (Way& own = way(vertex); own.place < 0) {
        own.place = 0;
        found.push_back(vertex);
      }
      spread(vertex, distance);
    });
  while (cross());
  for (Index vertex : touched) way(vertex).tentative = far_away;
  return found;
}

/// Whether a vertex is ahead, unless the search knows a way to it that is no longer than this.
bool March::may_be_nearer(Index vertex, double distance) const {
  const Index number = numbers_.find(vertex);
  if (number < 0) return number != ReachedNumbers::forgotten;
  return !ways_[number]->accepted && !(ways_[number]->tentative <= distance);
}

/// The places in the band next to vertices that are neither behind the front nor in the band.
void March::find_edge(Band& band) {
  for (std::size_t k = 0; k < band.own; ++k) {
    const Star star = graph_.star(band.vertices[k]);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      if (star.weights[e] == 0 || accepted(j) || place(j) >= 0) continue;
      band.edge.push_back(static_cast<Index>(k));
      break;
    }
  }
}

}  // namespace ahm
