/// \file
/// Simulates how the bands of a march would be distributed over ranks, without solving them.
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

/// How tiles are assigned to ranks.
enum class Deal {
  ranges,   ///< consecutive tiles, with about the same number of vertices per rank
  cards,    ///< tile t belongs to rank t modulo the number of ranks
  arrival,  ///< tiles sorted by distance from the source, dealt in rounds of one tile per rank
};

/// Straight-line distance from the middle of each tile to the nearest source, world units. A front reaches the tiles approximately in
/// this order.
/// @param middles  `TiledGraph::middles`
std::vector<double> tile_distances(std::span<const Vec3> middles, std::span<const Vec3> sources);

/// Assigns tiles to ranks.
/// @param first_vertex  first vertex of each tile, and last the number of vertices
/// @param ranks         number of ranks, >= 1
/// @param distances     distance of each tile from the source, for `arrival`
/// @return the rank of each tile
/// @throws InvalidArgument (number of distances)
std::vector<int> deal_tiles(std::span<const Index> first_vertex, Deal deal, int ranks,
                            std::span<const double> distances = {});

/// First vertex of each of several tiles of equal size, and last the number of vertices: for simulating a large cloud with a small
/// one. The vertices are ordered along the curve along which tiles are cut.
/// @throws InvalidArgument (no tiles, or more tiles than vertices)
std::vector<Index> equal_tiles(Index vertices, Index tiles);

/// Options of the simulation.
struct ScheduleOptions {
  double step = 10;   ///< distance that the front moves per band along edge paths, mean edge lengths; > 0
  double width = 24;  ///< depth of a band, mean edge lengths; >= step
};

/// Vertices of one band, by tile.
struct BandTiles {
  std::vector<std::pair<std::size_t, std::int64_t>> vertices;  ///< tile, and number of vertices in it
  /// Pair of tiles, and number of vertices in the first that have neighbors in the second.
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, std::int64_t>> borders;
};

/// The bands of a front that moves along shortest edge paths. Requires 4 bytes per vertex, and reads the graph once.
/// @param first_vertex  first vertex of each tile, as in `deal_tiles`
/// @throws InvalidArgument (options); IoError
std::vector<BandTiles> march_schedule(const TiledGraph& graph, std::span<const Vertex> sources,
                                      std::span<const Index> first_vertex, const ScheduleOptions& options);

/// Load of the ranks, if after each band every rank waits for all others.
struct SharedLoad {
  std::int64_t solved = 0;        ///< vertices of all bands together
  std::int64_t largest_band = 0;  ///< vertices of the largest band
  std::int64_t largest_part = 0;  ///< largest number of vertices of one rank in one band
  double active = 0;              ///< mean number of ranks with vertices in a band
  double messages =
      0;  ///< mean number per band of ordered pairs of ranks with neighboring vertices: messages of one halo exchange
  double halo = 0;  ///< mean over bands of the largest number of vertices that a rank sends, upper bound
  double balance =
      0;  ///< vertices solved, divided by the number if all ranks were as busy as the busiest; 1: no waiting
};
/// Computes the load of the ranks. @param owner_of_tile  rank of each tile
SharedLoad share_out(std::span<const BandTiles> bands, std::span<const int> owner_of_tile, int ranks);

}  // namespace ahm::tiles
