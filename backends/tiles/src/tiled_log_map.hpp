/// \file
/// Who of those who make a map together owns which tile.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "ahm/tiles/tiled_log_map.hpp"
#include "maps/march.hpp"

namespace ahm::tiles {

/// The same for all members but for their rank.
struct TileOwners {
  int rank = 0, ranks = 1;   ///< of this member, of how many
  std::vector<int> of_tile;  ///< rank of the owner of each tile

  bool owns(std::size_t tile) const { return of_tile[tile] == rank; }
};

/// As `write_log_map`, called by all members of the team with the same arguments; each writes its own tiles, the first one map.json.
/// @param owners  in accordance with `team.owns`
/// @return of all members together
TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners);

}  // namespace ahm::tiles
