/// \file
/// Log maps over tiles by a team of ranks.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "ahm/tiles/tiled_log_map.hpp"
#include "maps/march.hpp"

namespace ahm::tiles {

/// The owner of each tile. All members have the same data, except for their rank.
struct TileOwners {
  int rank = 0, ranks = 1;   ///< rank of this member, number of ranks
  std::vector<int> of_tile;  ///< rank of the owner of each tile

  bool owns(std::size_t tile) const { return of_tile[tile] == rank; }
};

/// Makes a map as `write_log_map`. All members of the team must call it with the same arguments. Each member writes its own tiles, and
/// the first one map.json.
/// @param owners  must be consistent with `team.owns`
/// @return the summary of all members together
TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners);

}  // namespace ahm::tiles
