/// \file
/// map.json: that a map is finished, and what it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "ahm/tiles/array_file.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "maps/march.hpp"
#include "tiled_log_map.hpp"

namespace ahm::tiles {

/// What map.json of a folder says; no object where there is none.
nlohmann::json read_finished(const std::filesystem::path& folder);
/// Whether the folder has something finished, of this identity.
bool is_finished(const std::filesystem::path& folder, std::uint64_t identity);
/// Written last of all. @throws IoError
void write_finished(const std::filesystem::path& folder, const nlohmann::json& summary);

/// The rows of one tile. NaN, and a status of its own, where nothing is known.
struct MapTile {
  static constexpr std::string_view kind = "map";
  static constexpr std::uint8_t untold = 255;

  MapTile(std::size_t vertices, MarchGoal goal);
  /// @throws IoError
  MapTile(const std::filesystem::path& path, MarchGoal goal);
  void write(const std::filesystem::path& path) const;
  void clear(std::size_t row);
  std::size_t bytes() const;

  std::vector<double> coordinates, spread;  ///< empty where distances are all there is
  std::vector<double> distance;
  std::vector<std::uint8_t> status;
  std::int64_t used = 0;
  bool is_saved = false;
};

/// Takes rows, and writes a tile when it has all of its, or when memory is short.
class MapWriter final : public MapSink {
 public:
  /// @param graph, owners  must outlive it
  /// @param memory         bytes of tiles at a time
  MapWriter(const TiledGraph& graph, const std::filesystem::path& folder, MarchGoal goal, std::size_t memory,
            const TileOwners& owners);

  /// Removes what is there of own tiles.
  void begin_anew();
  /// Takes over what is there of own tiles, as far as the march had come then: of what a later one found nothing stays.
  void go_on(const MarchState& state, std::int64_t ok, double farthest);
  void put(Index vertex, const MapRow& row) override;
  /// Writes all tiles that are in memory.
  void save();
  /// Says of the vertices that the march did not come to why.
  void finish(const Source& source, double radius);

  std::int64_t ok() const { return ok_; }
  double farthest() const { return farthest_; }
  std::int64_t spills() const { return spills_; }

 private:
  std::filesystem::path path(std::size_t tile) const { return Manifest::file(folder_, MapTile::kind, tile); }
  Index vertices(std::size_t tile) const { return graph_.manifest().tiles[tile].vertices; }
  MapTile& open(std::size_t number);
  bool spill(std::size_t keep);
  void close(std::size_t number);
  void save(std::size_t number);

  const TiledGraph& graph_;
  std::filesystem::path folder_;
  MarchGoal goal_;
  std::size_t memory_, bytes_ = 0;
  const TileOwners& owners_;
  std::vector<std::unique_ptr<MapTile>> tiles_;
  std::vector<Index> left_;  ///< vertices not told of yet
  std::vector<char> begun_;
  std::int64_t clock_ = 0, ok_ = 0, spills_ = 0;
  double farthest_ = 0;
};

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

}  // namespace ahm::tiles
