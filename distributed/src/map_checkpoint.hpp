/// \file
/// How far a map is, on disk: what it takes to go on after the process is gone.
///
/// Every so many bands each member writes its tiles of the map as they are, and its state of the march to NUMBER.front0 or
/// .front1, one after the other. When all have, the first writes march.json, which says whose turn it was: from then on that is
/// where another run goes on. Tiles on disk may be newer than that, never older; what they have more is forgotten.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ahm/distributed/array_file.hpp"
#include "map_writer.hpp"
#include "maps/march_team.hpp"

namespace ahm::distributed {

class MapCheckpoint final : public MarchKeeper {
 public:
  /// @param identity  of what the map is made, the same for all members
  /// @param every     bands from one checkpoint to the next; 0: none are made
  /// Others must outlive it. Called by all members.
  /// @throws InvalidArgument where the folder has a map that is not finished, of another identity; IoError
  MapCheckpoint(const std::filesystem::path& folder, std::uint64_t identity, Index every, const TiledGraph& graph,
                MarchTeam& team, const TileOwners& owners);

  /// Whose tiles are kept.
  void keep(MapWriter& writer) { writer_ = &writer; }
  std::optional<MarchState> begin() override;
  void end_band(const March& march) override;
  /// Bands after which the run goes on, 0: from the source.
  Index begun_at() const { return begun_at_; }
  /// The map is finished. Called by all members.
  void remove();

 private:
  void read_record();
  void record();
  std::filesystem::path record_file() const { return folder_ / "march.json"; }
  std::filesystem::path state_file(int slot, int rank) const;
  ArrayFile open_state(int rank) const;
  std::vector<std::uint64_t> identity_of(Index bands, int rank) const;
  MarchState own_state();
  MarchState dealt_state();
  bool is_near(Index vertex) const;

  std::filesystem::path folder_;
  std::uint64_t identity_;
  Index every_, begun_at_ = 0, last_ = 0;
  int slot_ = 0;   ///< of the last checkpoint
  int ranks_ = 0;  ///< that made it
  MapWriter* writer_ = nullptr;
  const TiledGraph& graph_;
  MarchTeam& team_;
  const TileOwners& owners_;
};

}  // namespace ahm::distributed
