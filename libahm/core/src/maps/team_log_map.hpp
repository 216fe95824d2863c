/// \file
/// A streamed log map that several machines make together.
#pragma once

#include "ahm/maps/streamed_log_map.hpp"
#include "maps/march.hpp"
#include "maps/march_team.hpp"

namespace ahm {

/// As `stream_log_map` or `stream_distances`, called by all members of the team with the same arguments but for `sink`, which is told of
/// the member's own vertices alone. The graph is asked for stars of these, and for masses and edge lengths of the source's vertices.
/// @param keeper  null: nothing is kept. Else each member has its own, the march goes on from where they say, and sinks are told
///                of what comes after that
MarchStatistics team_log_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                             const MapOptions& map, MapSink& sink, MarchTeam& team, MarchGoal goal = MarchGoal::map,
                             MarchKeeper* keeper = nullptr);

}  // namespace ahm
