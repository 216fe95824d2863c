/// \file
/// Writes tiles of a map, its summary map.json, and its checkpoints.
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

/// The contents of map.json in a folder; not an object if there is none.
nlohmann::json read_finished(const std::filesystem::path& folder);
/// Whether the folder has a finished map of this identity.
bool is_finished(const std::filesystem::path& folder, std::uint64_t identity);
/// Writes map.json, the last file of a map. @throws IoError
void write_finished(const std::filesystem::path& folder, const nlohmann::json& summary);

/// The rows of one tile of a map. Rows without a result have NaN and the status `not_set`.
struct MapTile {
  static constexpr std::string_view kind = "map";
  static constexpr std::uint8_t not_set = 255;

  MapTile(std::size_t vertices, MarchGoal goal);
  /// Reads a tile. @throws IoError
  MapTile(const std::filesystem::path& path, MarchGoal goal);
  void write(const std::filesystem::path& path) const;
  void clear(std::size_t row);
  std::size_t bytes() const;

  std::vector<double> coordinates, spread;  ///< empty for maps of distances
  std::vector<double> distance;
  std::vector<std::uint8_t> status;
  std::int64_t used = 0;
  bool is_saved = false;
};

/// Collects rows, and writes a tile when all its rows are there, or when the memory limit is reached.
class MapWriter final : public MapSink {
 public:
  /// @param graph, owners  must outlive the writer
  /// @param memory         limit for tiles in memory, bytes
  MapWriter(const TiledGraph& graph, const std::filesystem::path& folder, MarchGoal goal, std::size_t memory,
            const TileOwners& owners);

  /// Removes the files of own tiles.
  void remove_own_files();
  /// Resumes from the files of own tiles. Keeps the rows that the march had accepted in this state, and clears all later ones.
  void resume_from(const MarchState& state, std::int64_t ok, double farthest);
  void add(Index vertex, const MapRow& row) override;
  /// Writes all tiles that are in memory.
  void save();
  /// Sets the status of the vertices that the march did not reach.
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
  std::vector<Index> left_;  ///< number of vertices without a row, per tile
  std::vector<char> begun_;  ///< whether a tile has rows, per tile
  std::int64_t clock_ = 0, ok_ = 0, spills_ = 0;
  double farthest_ = 0;
};

/// Checkpoints of a march, from which a killed run can resume.
class MapCheckpoint final : public MarchKeeper {
 public:
  /// All members must call it. References must outlive the object.
  /// @param identity  checksum of the inputs of the map, the same for all members
  /// @param every     bands between checkpoints; 0: no checkpoints
  /// @throws InvalidArgument (the folder has an unfinished map of another identity), IoError
  MapCheckpoint(const std::filesystem::path& folder, std::uint64_t identity, Index every, const TiledGraph& graph,
                MarchTeam& team, const TileOwners& owners);

  /// Sets the writer whose tiles belong to the checkpoint.
  void keep(MapWriter& writer) { writer_ = &writer; }
  std::optional<MarchState> begin() override;
  void end_band(const March& march) override;
  /// Number of bands of the checkpoint from which the run resumes; 0: starts at the source.
  Index begun_at() const { return begun_at_; }
  /// Removes the checkpoints of a finished map. All members must call it.
  void remove();

 private:
  void read_record();
  void record();
  std::filesystem::path record_file() const { return folder_ / "march.json"; }
  std::filesystem::path state_file(int slot, int rank) const;
  ArrayFile open_state(int rank) const;
  std::vector<std::uint64_t> identity_of(Index bands, int rank) const;
  MarchState own_state();
  MarchState redistributed_state();
  bool is_near(Index vertex) const;

  std::filesystem::path folder_;
  std::uint64_t identity_;
  Index every_, begun_at_ = 0, last_ = 0;
  int slot_ = 0;   ///< slot of the last checkpoint, 0 or 1
  int ranks_ = 0;  ///< number of ranks that wrote the last checkpoint
  MapWriter* writer_ = nullptr;
  const TiledGraph& graph_;
  MarchTeam& team_;
  const TileOwners& owners_;
};

}  // namespace ahm::tiles
