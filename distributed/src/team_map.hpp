/// \file
/// The log map of a tiled graph that several processes make together, each for tiles of its own.
#pragma once

#include <filesystem>

#include "ahm/distributed/tiled_log_map.hpp"
#include "maps/march_team.hpp"
#include "tile_owners.hpp"

namespace ahm::distributed {

/// As `write_log_map`, called by all members of the team with the same arguments; each writes its own tiles, the first one map.json.
/// @param owners  in accordance with `team.owns`
/// @return of all members together
TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team, const TileOwners& owners);

}  // namespace ahm::distributed
