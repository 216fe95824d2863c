#include "ahm/distributed/march_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm::distributed {
namespace {

constexpr float far_away = std::numeric_limits<float>::infinity();

void check(const ScheduleOptions& options) {
  if (!(options.step > 0) || !(options.width >= options.step) || !std::isfinite(options.width))
    throw InvalidArgument("step is " + detail::number(options.step) + " and width " + detail::number(options.width) +
                          "; 0 < step <= width is needed");
}

}  // namespace

std::vector<int> deal_tiles(std::span<const Index> first, Deal deal, int ranks) {
  std::vector<int> owner(first.size() - 1);
  for (std::size_t t = 0; t < owner.size(); ++t)
    owner[t] = deal == Deal::cards ? static_cast<int>(t % static_cast<std::size_t>(ranks))
                                   : static_cast<int>((std::int64_t{first[t]} + first[t + 1]) * ranks /
                                                      std::max<std::int64_t>(2 * std::int64_t{first.back()}, 1));
  for (int& rank : owner) rank = std::min(rank, ranks - 1);
  return owner;
}

std::vector<Index> equal_tiles(Index vertices, Index tiles) {
  if (tiles < 1) throw InvalidArgument("tiles is " + std::to_string(tiles) + "; it must be at least 1");
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
  std::vector<std::map<std::size_t, std::int64_t>> bands;
  paths.run([&](Index vertex, float distance) {
    // Band b reaches from b step to b step + width.
    const auto last = static_cast<std::size_t>(distance / options.step);
    const auto first =
        static_cast<std::size_t>(std::max(0.0, std::floor((distance - options.width) / options.step) + 1));
    if (bands.size() <= last) bands.resize(last + 1);
    const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    const auto tile = static_cast<std::size_t>(next - first_vertex.begin() - 1);
    for (std::size_t b = std::min(first, last); b <= last; ++b) ++bands[b][tile];
    const double h = graph.component_edge_length(vertex);
    const Star star = graph.star(vertex);
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0) paths.offer(star.neighbors[e], static_cast<float>(distance + length(star.log(e)) / h));
  });
  std::vector<BandTiles> result;
  for (const auto& band : bands) result.emplace_back(band.begin(), band.end());
  return result;
}

SharedLoad share_out(std::span<const BandTiles> bands, std::span<const int> owner_of_tile, int ranks) {
  SharedLoad load;
  std::int64_t busiest = 0, active = 0;
  for (const BandTiles& band : bands) {
    std::vector<std::int64_t> part(static_cast<std::size_t>(ranks), 0);
    std::int64_t all = 0;
    for (const auto& [tile, vertices] : band) {
      part[static_cast<std::size_t>(owner_of_tile[tile])] += vertices;
      all += vertices;
    }
    const std::int64_t most = *std::max_element(part.begin(), part.end());
    load.solved += all;
    load.largest_band = std::max(load.largest_band, all);
    load.largest_part = std::max(load.largest_part, most);
    busiest += most;
    active += ranks - std::count(part.begin(), part.end(), 0);
  }
  if (bands.empty()) return load;
  load.active = static_cast<double>(active) / static_cast<double>(bands.size());
  load.balance = static_cast<double>(load.solved) / (static_cast<double>(busiest) * ranks);
  return load;
}

}  // namespace ahm::distributed
