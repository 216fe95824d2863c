/// \file
/// The log map of a tiled graph that several processes make together, each for tiles of its own.
#pragma once

#include <filesystem>
#include <functional>

#include "ahm/distributed/tiled_log_map.hpp"
#include "maps/march_team.hpp"

namespace ahm::distributed {

/// As `write_log_map`, called by all members of the team with the same arguments but for `owns_tile`; each writes its own tiles,
/// the owner of the first one map.json.
/// @param owns_tile  in accordance with `team.owns`
/// @return of all members together
TiledMapSummary team_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                             const TiledMapOptions& options, MarchTeam& team,
                             const std::function<bool(std::size_t)>& owns_tile);

}  // namespace ahm::distributed
