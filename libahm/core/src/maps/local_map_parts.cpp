#include "maps/local_map_parts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

/// Smallest number of bytes per entry of the result.
double entry_bytes(const TangentGraph& graph, bool quality) {
  return static_cast<double>(2 * sizeof(Index) +
                             sizeof(double) * (2 + (quality ? 1 : 0) + static_cast<std::size_t>(graph.dimension()) +
                                               graph.transport_layout().width()));
}

/// Appends a column of all entries, and frees the parts one by one. @param total  expected size of the column in the end
template <class T>
void join(std::vector<LocalEntries>& entries, std::vector<T> LocalEntries::*column, std::size_t total,
          std::vector<T>& out) {
  if (out.empty()) out.reserve(total);
  for (LocalEntries& e : entries) {
    out.insert(out.end(), (e.*column).begin(), (e.*column).end());
    e.*column = {};
  }
}

}  // namespace

void check_extent(const LocalMapOptions& options) {
  if (options.k < 0) throw InvalidArgument("k is " + std::to_string(options.k) + "; it must be >= 0 (0: all)");
  const bool by_number = options.radius == 0 && options.k > 0;
  if (!by_number && (!(options.radius > 0) || !std::isfinite(options.radius)))
    throw InvalidArgument("radius is " + detail::number(options.radius) +
                          "; it must be finite and > 0, or 0 if `k` is > 0");
}

NearestRadius radius_of_nearest(const TangentGraph& graph, Ball& ball, const Source& source,
                                const LocalMapOptions& options) {
  Index count = 0, vertices = 0;
  double farthest = graph.mean_edge_length() / 4;
  ball.grow(source.vertices(), std::numeric_limits<double>::infinity(), [&](Index vertex, double distance) {
    farthest = std::max(farthest, distance);
    ++vertices;
    if (is_neighbor(options, vertex)) ++count;
    return count < options.k;
  });
  return {farthest * graph.length_unit(), count < options.k, vertices};
}

void check_memory(const TangentGraph& graph, std::span<const Source> sources,
                  const std::function<double(std::size_t)>& radius, const LocalMapOptions& options) {
  const double memory = options.memory > 0 ? static_cast<double>(options.memory) : machine_memory();
  if (!(memory > 0) || sources.empty()) return;
  const double half = 0.5 * static_cast<double>(sources.size()) * entry_bytes(graph, options.quality),
               enough = memory / half;
  if (enough >= graph.size()) return;
  constexpr std::size_t most = 15;
  const std::size_t samples = std::min(most, sources.size());
  std::vector<double> counts;
  Ball ball(graph);
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t s = (2 * k + 1) * sources.size() / (2 * samples);
    double count = 0;
    ball.grow(sources[s].vertices().first(1), radius(s) / graph.length_unit(), [&](Index vertex, double) {
      if (options.k > 0 && count >= options.k) return false;
      if (is_neighbor(options, vertex)) ++count;
      return count <= enough;
    });
    counts.push_back(count);
  }
  std::sort(counts.begin(), counts.end());
  if (const double count = counts[samples / 2]; count > enough)
    throw ResourceExhausted("half of the " + std::to_string(sources.size()) + " local maps would contain more than " +
                            detail::number(std::floor(enough)) + " vertices each, which exceeds the memory of " +
                            detail::gigabytes(memory) +
                            "; use a smaller radius, fewer sources, or only the nearest vertices");
}

void append(const TangentGraph& graph, std::vector<LocalEntries>& entries, std::size_t total, LocalMaps& maps,
            unsigned threads) {
  const auto append_vertices = [&] {
    if (maps.weights.empty()) maps.weights.reserve(total);
    for (const LocalEntries& e : entries)
      for (const Vertex j : e.vertices) maps.weights.push_back(world_mass(graph, graph.mass(j.index)));
    join(entries, &LocalEntries::vertices, total, maps.neighbors);
  };
  const auto append_numbers = [&] {
    join(entries, &LocalEntries::distances, total, maps.distances);
    join(entries, &LocalEntries::transports, total * graph.transport_layout().width(), maps.transports);
    join(entries, &LocalEntries::logs, total * static_cast<std::size_t>(graph.dimension()), maps.logs);
    if (std::ranges::any_of(entries, [](const LocalEntries& e) { return !e.quality.empty(); }))
      join(entries, &LocalEntries::quality, total, maps.quality);
  };
  detail::run_both(threads, append_numbers, append_vertices);
}

LocalMaps joined(const TangentGraph& graph, std::vector<Offset> indptr, std::vector<LocalEntries>& entries,
                 unsigned threads) {
  LocalMaps maps;
  maps.dimension = graph.dimension();
  maps.kind = graph.transport_kind();
  maps.indptr = std::move(indptr);
  append(graph, entries, static_cast<std::size_t>(maps.indptr.back()), maps, threads);
  return maps;
}

}  // namespace ahm
