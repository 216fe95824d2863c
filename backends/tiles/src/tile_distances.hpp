/// \file
/// Distances over tiles that are computed before the march of a map, in one pass over the graph.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "ahm/maps/source.hpp"
#include "ahm/progress.hpp"
#include "ahm/tiles/array_file.hpp"
#include "ahm/tiles/tiled_graph.hpp"
#include "maps/streamed_log_map.hpp"

namespace ahm::tiles {

/// Computes distances from a source by a wavefront on a Delaunay triangulation, and writes them in the format of maps of distances,
/// map.json last. Skips the work if they exist already. Requires 30 bytes per vertex of the graph.
/// @param radius    largest distance, world units
/// @param memory    limit for tiles of distances in memory, bytes
/// @param identity  identity of the graph and the source
/// @throws Cancelled, IoError
void find_distances(const TiledGraph& graph, const Source& source, double radius, const std::filesystem::path& folder,
                    std::size_t memory, std::uint64_t identity, const Progress& progress);

/// The distances that `find_distances` wrote.
class TileDistances final : public KnownDistances {
 public:
  /// @param graph  must outlive the distances
  TileDistances(const TiledGraph& graph, const std::filesystem::path& folder);
  /// Distance of a vertex, world units; infinite beyond the radius. @throws IoError
  double of(Index vertex) const override;

 private:
  const TiledGraph& graph_;
  std::filesystem::path folder_;
  mutable std::vector<std::unique_ptr<const ArrayFile>> files_;  ///< files that were used, by tile
  mutable std::size_t last_ = 0;
};

}  // namespace ahm::tiles
