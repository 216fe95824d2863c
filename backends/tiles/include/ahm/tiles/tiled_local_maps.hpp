/// \file
/// The map around every vertex of a tiled graph, tile by tile.
///
/// \code
/// for (std::size_t tile = 0; tile < graph.tiles(); ++tile)     // or one process per tile
///   ahm::tiles::write_local_maps(graph, tile, "neighbours", {.maps = {.radius = 0.05}, .features = {"count", "curvature"}});
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "ahm/maps/local_maps.hpp"
#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

struct TiledLocalMapOptions {
  LocalMapOptions maps;  ///< with a radius
  /// What is kept of each map; nothing given: all of `LocalMaps`, as arrays indptr, neighbors (vertices of the whole graph), logs,
  /// distances, weights, transports. Else these, a row per vertex of the tile, instead:
  ///
  /// | name        | arrays       | |
  /// |-------------|--------------|-|
  /// | `count`     | count        | how many vertices the map has (Index) |
  /// | `area`      | area         | their masses together |
  /// | `mean:FILE` | mean         | of a number per row of the input, FILE.npy (float64), each vertex with its mass, one with several rows with their mean; a column for each FILE, in the order given |
  /// | `curvature` | curvatures   | kappa_1, kappa_2 as `PrincipalCurvatures`, of a paraboloid over the coordinates of the map, each vertex with its mass; NaN where the vertices do not tell |
  /// |             | directions   | unit vector of space along which the curvature is kappa_1, up to its sign |
  std::vector<std::string> features = {};
};

/// @throws InvalidArgument, IoError where `write_local_maps` would of these options, whatever the tile
void check_local_maps(const TiledGraph& graph, const TiledLocalMapOptions& options);

/// The local maps of a tile's vertices, in the file NUMBER.local of the folder; row i is vertex graph.first_vertex(tile) + i.
///
/// They are those of `local_maps` on the whole graph but for which sources share a patch, hence as far as
/// `LocalMapOptions::margin` says; the same to rounding on flat clouds. Memory is in proportion to the tile with what is within
/// twice the radius of it, and to its maps; with features to those of some thousand vertices at a time.
/// @return false where the file is there already, made of the same graph with the same options
/// @throws InvalidArgument (options; a FILE that has not a number per row; a file that was made with others), and as `local_maps`; IoError
bool write_local_maps(const TiledGraph& graph, std::size_t tile, const std::filesystem::path& folder,
                      const TiledLocalMapOptions& options);

/// Features of all tiles as CSV: row, count, area, curvature_1, curvature_2, direction_x, direction_y, direction_z, mean_0, ..., as far
/// as they were asked for; rows of the input tile by tile, those without a vertex with nothing.
/// @throws IoError (a tile is missing, damaged, of another graph, has whole maps, or other features than the first)
void write_feature_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv);

}  // namespace ahm::tiles
