/// \file
/// A streamed log map that several machines make together.
#pragma once

#include "ahm/maps/streamed_log_map.hpp"
#include "maps/march.hpp"

namespace ahm {

/// How a team makes a map.
struct TeamMarch {
  MarchGoal goal = MarchGoal::map;
  /// Null: nothing is kept. Else each member has its own, the march goes on from where they say, and sinks are told of what comes
  /// after that.
  MarchKeeper* keeper = nullptr;
  /// Null: those of heat, or unfolded by each member for itself.
  const KnownDistances* distances = nullptr;
};

/// What `team_log_map` asks of its arguments. @throws InvalidArgument
void check_streamed_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                        const MapOptions& map);

/// As `stream_log_map` or `stream_distances`, called by all members of the team with the same arguments but for `sink`, which is told of
/// the member's own vertices alone. The graph is asked for stars of these, and for masses and edge lengths of the source's vertices.
MarchStatistics team_log_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                             const MapOptions& map, MapSink& sink, MarchTeam& team, const TeamMarch& how = {});

}  // namespace ahm
