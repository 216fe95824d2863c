#include "ahm/distributed/tiled_local_maps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "graph/patch.hpp"
#include "maps/ball.hpp"

namespace ahm::distributed {
namespace {

constexpr std::string_view local_kind = "local";

/// No patch of local_maps reaches farther than this many times the radius and its margin, along edges.
constexpr double longest_detour = 2;

/// A tile's vertices with all that their maps are made of.
struct Region {
  std::vector<Index> vertices;  ///< ascending
  Index begin = 0, end = 0;     ///< the tile's own
};

Region region_of(const TiledGraph& graph, std::size_t tile, const LocalMapOptions& options) {
  const Index first = graph.first_vertex(tile), last = graph.first_vertex(tile + 1);
  std::vector<Vertex> own;
  double h = 0;
  for (Index i = first; i < last; ++i) {
    own.emplace_back(i);
    h = std::max(h, graph.component_edge_length(i));
  }
  const double far = options.radius / graph.length_unit() + options.margin * std::sqrt(options.heat.t_coef) * h;
  Region region;
  Ball(graph).grow(own, longest_detour * far, [&](Index vertex, double) {
    region.vertices.push_back(vertex);
    return true;
  });
  // And their neighbours, so that it can be seen where patches end.
  const std::size_t inside = region.vertices.size();
  for (std::size_t k = 0; k < inside; ++k)
    for (Index j : graph.star(region.vertices[k]).neighbors) region.vertices.push_back(j);
  std::sort(region.vertices.begin(), region.vertices.end());
  region.vertices.erase(std::unique(region.vertices.begin(), region.vertices.end()), region.vertices.end());
  const auto place = [&](Index vertex) {
    return static_cast<Index>(std::lower_bound(region.vertices.begin(), region.vertices.end(), vertex) -
                              region.vertices.begin());
  };
  region.begin = place(first), region.end = place(last);
  return region;
}

/// Part of the graph with the scales of the whole.
CsrGraph graph_of(const TiledGraph& graph, const Region& region) {
  CsrGraphData data = cut_out(
                          graph, region.vertices,
                          [&](Index vertex) {
                            const auto at = std::lower_bound(region.vertices.begin(), region.vertices.end(), vertex);
                            return at == region.vertices.end() || *at != vertex
                                       ? Index{-1}
                                       : static_cast<Index>(at - region.vertices.begin());
                          },
                          [](std::size_t, const Star&, std::size_t) { return 0.0; })
                          .data();
  for (Index vertex : region.vertices) data.component_edge_lengths.push_back(graph.component_edge_length(vertex));
  return CsrGraph(std::move(data));
}

/// What the file is made of.
std::vector<std::uint64_t> identity_of(const TiledGraph& graph, std::size_t tile, const TiledLocalMapOptions& options) {
  std::vector<std::uint64_t> result = graph.manifest().identity(tile);
  const LocalMapOptions& o = options.maps;
  for (double x : {o.radius, o.margin, o.heat.t_coef}) result.push_back(std::bit_cast<std::uint64_t>(x));
  for (auto x : {static_cast<int>(o.nearest), static_cast<int>(o.heat.variant), static_cast<int>(options.keep)})
    result.push_back(static_cast<std::uint64_t>(x));
  return result;
}

void write(const std::filesystem::path& path, const std::vector<std::uint64_t>& identity, const LocalMaps& maps,
           Keep keep) {
  if (keep == Keep::maps) {
    write_arrays(path, local_kind,
                 {array("identity", identity), array("indptr", maps.indptr), array("neighbors", maps.neighbors),
                  array("logs", maps.logs), array("distances", maps.distances), array("weights", maps.weights),
                  array("transports", maps.transports)});
    return;
  }
  std::vector<Index> count;
  std::vector<double> area;
  for (std::size_t s = 0; s + 1 < maps.indptr.size(); ++s) {
    count.push_back(static_cast<Index>(maps.indptr[s + 1] - maps.indptr[s]));
    double sum = 0;
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e) sum += maps.weights[static_cast<std::size_t>(e)];
    area.push_back(sum);
  }
  write_arrays(path, local_kind, {array("identity", identity), array("count", count), array("area", area)});
}

}  // namespace

bool write_local_maps(const TiledGraph& graph, std::size_t tile, const std::filesystem::path& folder,
                      const TiledLocalMapOptions& options) {
  if (tile >= graph.tiles())
    throw InvalidArgument("tile " + std::to_string(tile) + " is not there; there are " + std::to_string(graph.tiles()));
  if (!(options.maps.radius > 0) || !std::isfinite(options.maps.radius))
    throw InvalidArgument("radius is " + detail::number(options.maps.radius) + "; it must be finite and > 0");
  std::filesystem::create_directories(folder);
  const auto path = Manifest::file(folder, local_kind, tile);
  const std::vector<std::uint64_t> identity = identity_of(graph, tile, options);
  if (std::filesystem::exists(path)) {
    const ArrayFile file(path, local_kind);
    if (std::ranges::equal(file.get<std::uint64_t>("identity"), identity)) return false;
    throw InvalidArgument("'" + path.string() + "' was made of another graph or with other options; remove it first");
  }
  const Region region = region_of(graph, tile, options.maps);
  LocalMaps maps;
  maps.indptr = {0};
  if (region.begin < region.end) {
    const CsrGraph part = graph_of(graph, region);
    std::vector<Vertex> own;
    for (Index i = region.begin; i < region.end; ++i) own.emplace_back(i);
    LocalMapOptions solve = options.maps;
    solve.heat.check_graph = false;
    maps = local_maps(part, own, solve);
  }
  for (Vertex& vertex : maps.neighbors) vertex = Vertex(region.vertices[static_cast<std::size_t>(vertex.index)]);
  write(path, identity, maps, options.keep);
  return true;
}

}  // namespace ahm::distributed
