/// \file
/// How much of each band of a march would be whose, without marching.
///
/// \code
/// const auto tiles = graph.manifest().first_vertices();
/// const auto bands = ahm::tiles::march_schedule(graph, sources, tiles, {});
/// const auto load = ahm::tiles::share_out(bands, ahm::tiles::deal_tiles(tiles, ahm::tiles::Deal::cards, 64), 64);
/// \endcode
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

/// Which of several ranks owns which tile.
enum class Deal {
  ranges,   ///< successive tiles, as many vertices for each as for others
  cards,    ///< one after the other, as cards are dealt
  arrival,  ///< in the order in which a front comes to them, one for each before anyone gets another, along the curve
};

/// Straight distances from the nearest of some points to each tile's middle, in whose order a front comes to tiles, more or less.
/// @param middles  as `TiledGraph::middles`
std::vector<double> tile_distances(std::span<const Vec3> middles, std::span<const Vec3> sources);

/// @param first_vertex  of each tile, and the number of vertices
/// @param ranks         at least 1
/// @param distances     of the tiles, for `arrival`
/// @return of each tile its rank
/// @throws InvalidArgument (as many distances as tiles are needed)
std::vector<int> deal_tiles(std::span<const Index> first_vertex, Deal deal, int ranks,
                            std::span<const double> distances = {});

/// As if the vertices, whose order is that of the curve along which tiles are cut, were in so many tiles of equal size: where a
/// small cloud stands for a large one. @throws InvalidArgument (no tiles, or more than vertices)
std::vector<Index> equal_tiles(Index vertices, Index tiles);

struct ScheduleOptions {
  double step = 10;   ///< how far the front moves with each band, mean edge lengths along paths; > 0
  double width = 24;  ///< how far ahead a band reaches; >= step
};

/// Of a band's vertices ...
struct BandTiles {
  std::vector<std::pair<std::size_t, std::int64_t>> vertices;  ///< ... how many are in which tile
  /// ... and how many of a tile have neighbours in which other one.
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, std::int64_t>> borders;
};

/// The bands of a front that moves along shortest paths of the graph. Takes 4 bytes per vertex of the graph, and reads it once.
/// @param first_vertex  of each tile, as `deal_tiles`
/// @throws InvalidArgument (options); IoError
std::vector<BandTiles> march_schedule(const TiledGraph& graph, std::span<const Vertex> sources,
                                      std::span<const Index> first_vertex, const ScheduleOptions& options);

/// What ranks would have to do where each waits for all with each band.
struct SharedLoad {
  std::int64_t solved = 0;        ///< vertices of all bands
  std::int64_t largest_band = 0;  ///< vertices
  std::int64_t largest_part = 0;  ///< of a band, of one rank
  double active = 0;              ///< mean number of ranks that have something of a band
  double messages =
      0;  ///< mean number, over bands, of pairs of ranks of which one has neighbours of the other's: an exchange of halos sends as many
  double halo = 0;     ///< mean over bands of the most vertices that a rank tells others, at most
  double balance = 0;  ///< vertices solved over what the busiest rank of each band would allow; 1: no waiting
};
SharedLoad share_out(std::span<const BandTiles> bands, std::span<const int> owner_of_tile, int ranks);

}  // namespace ahm::tiles
