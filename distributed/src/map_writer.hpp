/// \file
/// The tiles of a map while they are filled.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "ahm/distributed/tiled_log_map.hpp"
#include "maps/march.hpp"
#include "tile_owners.hpp"

namespace ahm::distributed {

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

}  // namespace ahm::distributed
