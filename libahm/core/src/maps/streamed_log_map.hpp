/// \file
/// A streamed log map that several processes compute together.
#pragma once

#include "ahm/maps/streamed_log_map.hpp"
#include "maps/march.hpp"

namespace ahm {

/// Options of `team_log_map`.
struct TeamMarch {
  MarchGoal goal = MarchGoal::map;
  /// Null: the state is not saved. Otherwise each member has a keeper, and the march continues from the state of the keepers. The
  /// sinks then receive the rows after that state only.
  MarchKeeper* keeper = nullptr;
  /// Distances of the map. Null: distances by heat, or unfolded by each member for itself.
  const KnownDistances* distances = nullptr;
};

/// Checks the arguments of `team_log_map`. @throws InvalidArgument
void check_streamed_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                        const MapOptions& map);

/// As `stream_log_map` or `stream_distances`, but called by all members of a team with the same arguments, except `sink`, which receives
/// the member's own vertices only. The graph must provide the stars of these, and the masses and edge lengths of the source's vertices.
MarchStatistics team_log_map(const TangentGraph& graph, const Source& source, const HeatOptions& options,
                             const MapOptions& map, MapSink& sink, MarchTeam& team, const TeamMarch& how = {});

}  // namespace ahm
