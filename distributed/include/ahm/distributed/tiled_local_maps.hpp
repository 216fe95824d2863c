/// \file
/// The map around every vertex of a tiled graph, tile by tile.
///
/// \code
/// for (std::size_t tile = 0; tile < graph.tiles(); ++tile)     // or one process per tile
///   ahm::distributed::write_local_maps(graph, tile, "neighbours", {.maps = {.radius = 0.05}, .keep = ahm::distributed::Keep::counts});
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>

#include "ahm/distributed/tiled_graph.hpp"
#include "ahm/maps/local_maps.hpp"

namespace ahm::distributed {

/// What is kept of a map.
enum class Keep {
  maps,  ///< all of `LocalMaps`: arrays indptr, neighbors (vertices of the whole graph), logs, distances, weights, transports
  counts,  ///< of each vertex, how many vertices its map has and their masses together: arrays count, area
};

struct TiledLocalMapOptions {
  LocalMapOptions maps;  ///< with a radius
  Keep keep = Keep::maps;
};

/// The local maps of a tile's vertices, in the file NUMBER.local of the folder; row i is vertex graph.first_vertex(tile) + i.
///
/// They are those of `local_maps` on the whole graph but for which sources share a patch, hence as far as
/// `LocalMapOptions::margin` says; the same to rounding on flat clouds. Memory is in proportion to the tile with what is within
/// twice the radius of it, and to its maps.
/// @return false where the file is there already, made of the same graph with the same options
/// @throws InvalidArgument (options; a file that was made with others), and as `local_maps`; IoError
bool write_local_maps(const TiledGraph& graph, std::size_t tile, const std::filesystem::path& folder,
                      const TiledLocalMapOptions& options);

}  // namespace ahm::distributed
