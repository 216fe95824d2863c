/// \file
/// Distances over tiles that are known before a map is marched, from one pass over the whole graph.
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

/// Unfolds distances from a source on a Delaunay triangulation and writes them as tiles like those of maps of distances; and, last of
/// all, map.json. Where they are there they are not made again. Takes 30 bytes per vertex of the graph.
/// @param radius    how far, world units
/// @param memory    bytes of tiles of distances at a time
/// @param identity  of the graph and the source
/// @throws Cancelled, IoError
void find_distances(const TiledGraph& graph, const Source& source, double radius, const std::filesystem::path& folder,
                    std::size_t memory, std::uint64_t identity, const Progress& progress);

/// What `find_distances` has written.
class TileDistances final : public KnownDistances {
 public:
  /// @param graph  must outlive it
  TileDistances(const TiledGraph& graph, const std::filesystem::path& folder);
  /// Infinite beyond the radius. @throws IoError
  double of(Index vertex) const override;

 private:
  const TiledGraph& graph_;
  std::filesystem::path folder_;
  mutable std::vector<std::unique_ptr<const ArrayFile>> files_;  ///< those that were asked for
  mutable std::size_t last_ = 0;
};

}  // namespace ahm::tiles
