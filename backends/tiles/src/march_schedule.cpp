#include "ahm/tiles/march_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::tiles {
namespace {

constexpr float far_away = std::numeric_limits<float>::infinity();

void check(const ScheduleOptions& options) {
  if (!(options.step > 0) || !(options.width >= options.step) || !std::isfinite(options.width))
    throw InvalidArgument("step is " + detail::number(options.step) + " and width " + detail::number(options.width) +
                          "; 0 < step <= width < infinity is required");
}

}  // namespace

std::vector<double> tile_distances(std::span<const Vec3> middles, std::span<const Vec3> sources) {
  std::vector<double> result(middles.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < middles.size(); ++t)
    for (const Vec3& source : sources) result[t] = std::min(result[t], distance(middles[t], source));
  return result;
}

std::vector<int> deal_tiles(std::span<const Index> first, Deal deal, int ranks, std::span<const double> distances) {
  const std::size_t tiles = first.size() - 1, rank_count = to_size(ranks);
  std::vector<int> owner(tiles);
  if (deal == Deal::ranges)
    for (std::size_t t = 0; t < tiles; ++t) {
      const std::int64_t middle = std::int64_t{first[t]} + first[t + 1], all = 2 * std::int64_t{first.back()};
      owner[t] = std::min(static_cast<int>(middle * ranks / std::max<std::int64_t>(all, 1)), ranks - 1);
    }
  if (deal == Deal::cards)
    for (std::size_t t = 0; t < tiles; ++t) owner[t] = static_cast<int>(t % rank_count);
  if (deal != Deal::arrival) return owner;
  if (distances.size() != tiles)
    throw InvalidArgument("expected one distance per tile, found " + std::to_string(distances.size()) + " for " +
                          detail::counted(tiles, "tile"));
  std::vector<std::size_t> order(tiles);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return distances[a] < distances[b]; });
  for (std::size_t begin = 0; begin < tiles; begin += rank_count) {
    const std::size_t end = std::min(begin + rank_count, tiles);
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t k = begin; k < end; ++k) owner[order[k]] = static_cast<int>(k - begin);
  }
  return owner;
}

std::vector<Index> equal_tiles(Index vertices, Index tiles) {
  if (tiles < 1 || tiles > std::max(vertices, 1))
    throw InvalidArgument("tiles is " + std::to_string(tiles) +
                          "; it must be at least 1, and at most the number of vertices, " + std::to_string(vertices));
  std::vector<Index> first;
  for (std::int64_t t = 0; t <= tiles; ++t) first.push_back(static_cast<Index>(t * vertices / tiles));
  return first;
}

std::vector<BandTiles> march_schedule(const TiledGraph& graph, std::span<const Vertex> sources,
                                      std::span<const Index> first_vertex, const ScheduleOptions& options) {
  check(options);
  std::vector<float> known(static_cast<std::size_t>(graph.size()), far_away);
  ShortestPaths<float, std::vector<float>> paths(known, far_away);
  for (Vertex source : sources) paths.offer(source.index, 0);
  struct Band {
    std::map<std::size_t, std::int64_t> vertices;
    std::map<std::pair<std::size_t, std::size_t>, std::int64_t> borders;
  };
  std::vector<Band> bands;
  const auto tile_of = [&](Index vertex) {
    return static_cast<std::size_t>(std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex) -
                                    first_vertex.begin() - 1);
  };
  std::vector<std::size_t> others;
  paths.run([&](Index vertex, float distance) {
    const std::size_t tile = tile_of(vertex);
    const double h = graph.component_edge_length(vertex);
    const Star star = graph.star(vertex);
    others.clear();
    for (std::size_t e = 0; e < star.degree(); ++e) {
      if (star.weights[e] == 0) continue;
      paths.offer(star.neighbors[e], static_cast<float>(distance + length(star.log(e)) / h));
      if (star.neighbors[e] < first_vertex[tile] || star.neighbors[e] >= first_vertex[tile + 1])
        others.push_back(tile_of(star.neighbors[e]));
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    // Band b covers distances from b * step to b * step + width.
    const auto last = static_cast<std::size_t>(distance / options.step);
    const auto first =
        static_cast<std::size_t>(std::max(0.0, std::floor((distance - options.width) / options.step) + 1));
    if (bands.size() <= last) bands.resize(last + 1);
    for (std::size_t b = std::min(first, last); b <= last; ++b) {
      ++bands[b].vertices[tile];
      for (std::size_t other : others) ++bands[b].borders[{tile, other}];
    }
  });
  std::vector<BandTiles> result;
  for (const Band& band : bands)
    result.push_back({{band.vertices.begin(), band.vertices.end()}, {band.borders.begin(), band.borders.end()}});
  return result;
}

SharedLoad share_out(std::span<const BandTiles> bands, std::span<const int> owner_of_tile, int ranks) {
  SharedLoad load;
  std::int64_t busiest = 0, active = 0, sent_total = 0, messages = 0;
  for (const BandTiles& band : bands) {
    std::vector<std::int64_t> part(to_size(ranks), 0), sent(part);
    std::int64_t all = 0;
    for (const auto& [tile, vertices] : band.vertices) {
      part[to_size(owner_of_tile[tile])] += vertices;
      all += vertices;
    }
    std::set<std::pair<int, int>> pairs;
    for (const auto& [tiles, vertices] : band.borders) {
      const int from = owner_of_tile[tiles.first], to = owner_of_tile[tiles.second];
      if (from == to) continue;
      pairs.emplace(from, to);
      sent[to_size(from)] += vertices;
    }
    const std::int64_t most = *std::max_element(part.begin(), part.end());
    load.solved += all;
    load.largest_band = std::max(load.largest_band, all);
    load.largest_part = std::max(load.largest_part, most);
    busiest += most;
    active += ranks - std::count(part.begin(), part.end(), 0);
    sent_total += *std::max_element(sent.begin(), sent.end());
    messages += static_cast<std::int64_t>(pairs.size());
  }
  if (bands.empty()) return load;
  const auto count = static_cast<double>(bands.size());
  load.active = static_cast<double>(active) / count;
  load.messages = static_cast<double>(messages) / count;
  load.halo = static_cast<double>(sent_total) / count;
  load.balance = static_cast<double>(load.solved) / (static_cast<double>(busiest) * ranks);
  return load;
}

}  // namespace ahm::tiles
