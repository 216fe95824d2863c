/// \file
/// The map around every vertex of a tiled graph, tile by tile.
///
/// \code
/// for (std::size_t tile = 0; tile < graph.tiles(); ++tile)     // or one process per tile
///   ahm::tiles::write_local_maps(graph, tile, "neighbors", {.maps = {.radius = 0.05}, .features = {"count", "curvature"}});
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "ahm/maps/local_maps.hpp"
#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

/// Options of local maps of tiles.
struct TiledLocalMapOptions {
  LocalMapOptions maps;  ///< the radius is required
  /// Features to write for each map. Empty: the whole maps (`LocalMaps`), as the arrays indptr, neighbors (vertices of the whole
  /// graph), logs, distances, weights, transports. Otherwise only the features, one row per vertex of the tile:
  ///
  /// | name        | arrays       | |
  /// |-------------|--------------|-|
  /// | `count`     | count        | number of vertices in the map (Index) |
  /// | `area`      | area         | sum of their masses |
  /// | `mean:FILE` | mean         | mean, weighted by mass, of FILE.npy (float64, one value per row of the input); a column per FILE |
  /// | `curvature` | curvatures   | kappa_1, kappa_2 (`PrincipalCurvatures`) of a paraboloid fit weighted by mass; NaN if undetermined |
  /// |             | directions   | unit vector in space along which the curvature is kappa_1, up to its sign |
  std::vector<std::string> features = {};
};

/// Checks the options without a tile. @throws InvalidArgument, IoError (as `write_local_maps` would for any tile)
void check_local_maps(const TiledGraph& graph, const TiledLocalMapOptions& options);

/// Writes the local maps of a tile to the file NUMBER.local of the folder. Row i is vertex graph.first_vertex(tile) + i.
///
/// The maps equal those of `local_maps` on the whole graph up to the accuracy of `LocalMapOptions::margin`, because other sources share
/// a patch; on flat clouds they are equal up to rounding. Memory is proportional to the tile, the vertices within twice the radius
/// around it, and the maps; with features only the maps of 16,384 vertices are in memory.
/// @return false if the file exists already, for the same graph and options
/// @throws InvalidArgument (options; a FILE without one value per row; a file for another graph or other options), IoError, and as
/// `local_maps`
bool write_local_maps(const TiledGraph& graph, std::size_t tile, const std::filesystem::path& folder,
                      const TiledLocalMapOptions& options);

/// Writes the features of all tiles as CSV: row, count, area, curvature_1, curvature_2, direction_x, direction_y, direction_z, mean_0,
/// ..., restricted to the requested features. Writes the rows of the input tile by tile; rows without a vertex have empty fields.
/// @throws IoError (a tile is missing, damaged, of another graph, has whole maps, or other features than the first)
void write_feature_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv);

}  // namespace ahm::tiles
