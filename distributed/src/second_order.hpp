/// \file
/// Maps of second order over tiles: maps of several times, extrapolated tile by tile as in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "ahm/distributed/tiled_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/source.hpp"
#include "maps/extrapolate.hpp"
#include "maps/march.hpp"
#include "tile_owners.hpp"

namespace ahm::distributed {

/// Of one member's tiles.
struct CombinedRows {
  std::int64_t ok = 0;
  double farthest = 0;
};

/// The times of second order for the components of a source.
class TiledTimes {
 public:
  /// Called by all members, each of which counts the vertices of its own tiles. @param graph  must outlive it
  TiledTimes(const TiledGraph& graph, const Source& source, const HeatOptions& heat, MarchTeam& team,
             const TileOwners& owners);

  std::size_t count() const { return times_.count(); }
  double radius_of_each(double radius) const;
  /// Those of time k, which must not outlive this object.
  std::unique_ptr<const MarchScales> scales(std::size_t k) const;
  /// Writes the member's own tiles of the map.
  /// @param of_times  folders of the maps of all times
  /// @param paths     folder of the ways along edges; empty: distances are unfolded
  CombinedRows combine(const std::vector<std::filesystem::path>& of_times, const std::filesystem::path& paths,
                       const std::filesystem::path& folder, double radius, const TileOwners& owners) const;

 private:
  const TiledGraph& graph_;
  double t_coef_;
  DiffusionTimes times_;
};

}  // namespace ahm::distributed
