#include "ahm/tiles/tiled_local_maps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "graph/patch.hpp"
#include "local_features.hpp"
#include "maps/patch_maps.hpp"

namespace ahm::tiles {
namespace {

/// Patches of `local_maps` reach at most this multiple of the radius with its margin, along edges.
constexpr double longest_detour = 2;

/// Number of vertices whose maps are in memory at the same time when features are computed.
constexpr Index at_a_time = 1 << 14;

/// The vertices of a tile, with all vertices on which their maps depend.
struct Region {
  std::vector<Index> vertices;  ///< vertices of the whole graph, ascending
  Index begin = 0, end = 0;     ///< range of the tile's own vertices
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
  // Adds their neighbors, by which `local_maps` detects the borders of patches.
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

/// The part of the graph in a region, with the edge lengths of the whole graph, and with frames if distances are bounded by straight
/// lines.
CsrGraph graph_of(const TiledGraph& graph, const Region& region, const LocalMapOptions& options) {
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
  if (options.bound_by_straight_line)
    for (Index vertex : region.vertices) data.frames.push_back(*graph.frame(vertex));
  return CsrGraph(std::move(data));
}

/// Identity of a file: checksums of the graph, the options and the features.
std::vector<std::uint64_t> identity_of(const TiledGraph& graph, std::size_t tile, const TiledLocalMapOptions& options,
                                       const LocalFeatures& features) {
  std::vector<std::uint64_t> result = graph.manifest().identity(tile);
  const LocalMapOptions& o = options.maps;
  for (double x : {o.radius, o.margin, o.heat.t_coef}) result.push_back(std::bit_cast<std::uint64_t>(x));
  for (auto x : {static_cast<int>(o.k), static_cast<int>(o.heat.variant), static_cast<int>(o.bound_by_straight_line)})
    result.push_back(static_cast<std::uint64_t>(x));
  for (const std::string& name :
       options.features)  // only the name of the feature, because the path of a file does not matter
    result.push_back(checksum(std::as_bytes(std::span(name.data(), std::min(name.size(), name.find(':'))))));
  for (const auto& feature : features) result.push_back(feature->identity(tile));
  return result;
}

LocalFeatures checked_features(const TiledGraph& graph, const TiledLocalMapOptions& options) {
  if (!(options.maps.radius > 0) || !std::isfinite(options.maps.radius))
    throw InvalidArgument("radius is " + detail::number(options.maps.radius) + "; it must be finite and > 0");
  if (options.maps.quality) throw InvalidArgument("quality: local maps of tiles have none");
  return local_features(options.features, graph, options.maps.radius);
}

/// The maps of the vertices begin to end - 1 of a region. Neighbors are indices into the region.
LocalMaps maps_of(const CsrGraph& part, Index begin, Index end, const LocalMapOptions& options) {
  std::vector<Vertex> own;
  for (Index i = begin; i < end; ++i) own.emplace_back(i);
  LocalMapOptions solve = options;
  solve.heat.check_graph = false;
  return local_maps(part, own, solve);
}

void write_maps(const std::filesystem::path& path, const std::vector<std::uint64_t>& identity, const TiledGraph& graph,
                const Region& region, const LocalMapOptions& options) {
  LocalMaps maps;
  maps.indptr = {0};
  if (region.begin < region.end) maps = maps_of(graph_of(graph, region, options), region.begin, region.end, options);
  for (Vertex& vertex : maps.neighbors) vertex = Vertex(region.vertices[static_cast<std::size_t>(vertex.index)]);
  write_arrays(path, local_kind,
               {array("identity", identity), array("indptr", maps.indptr), array("neighbors", maps.neighbors),
                array("logs", maps.logs), array("distances", maps.distances), array("weights", maps.weights),
                array("transports", maps.transports)});
}

void write_features(const std::filesystem::path& path, const std::vector<std::uint64_t>& identity,
                    const TiledGraph& graph, const Region& region, const LocalMapOptions& options,
                    const LocalFeatures& features) {
  for (const auto& feature : features) feature->enter(region.vertices);
  const CsrGraph part = graph_of(graph, region, options);
  for (Index begin = region.begin; begin < region.end; begin += at_a_time) {
    const LocalMaps maps = maps_of(part, begin, std::min(begin + at_a_time, region.end), options);
    for (std::size_t s = 0; s + 1 < maps.indptr.size(); ++s) {
      const auto first = static_cast<std::size_t>(maps.indptr[s]),
                 size = static_cast<std::size_t>(maps.indptr[s + 1]) - first;
      const VertexMap map{std::span(maps.neighbors).subspan(first, size),
                          std::span(maps.logs).subspan(2 * first, 2 * size),
                          std::span(maps.weights).subspan(first, size)};
      for (const auto& feature : features) feature->add(map);
    }
  }
  std::vector<NamedArray> arrays{array("identity", identity)};
  for (const auto& feature : features) feature->append_to(arrays);
  write_arrays(path, local_kind, arrays);
}

}  // namespace

void check_local_maps(const TiledGraph& graph, const TiledLocalMapOptions& options) {
  checked_features(graph, options);
}

bool write_local_maps(const TiledGraph& graph, std::size_t tile, const std::filesystem::path& folder,
                      const TiledLocalMapOptions& options) {
  if (tile >= graph.tiles())
    throw InvalidArgument("tile " + std::to_string(tile) + " does not exist; the number of tiles is " +
                          std::to_string(graph.tiles()));
  const LocalFeatures features = checked_features(graph, options);
  std::filesystem::create_directories(folder);
  const auto path = Manifest::file(folder, local_kind, tile);
  const std::vector<std::uint64_t> identity = identity_of(graph, tile, options, features);
  if (std::filesystem::exists(path)) {
    const ArrayFile file(path, local_kind);
    if (std::ranges::equal(file.get<std::uint64_t>("identity"), identity)) return false;
    throw InvalidArgument("'" + path.string() + "' was made from another graph or with other options; remove it first");
  }
  const Region region = region_of(graph, tile, options.maps);
  if (features.empty())
    write_maps(path, identity, graph, region, options.maps);
  else
    write_features(path, identity, graph, region, options.maps, features);
  return true;
}

}  // namespace ahm::tiles
