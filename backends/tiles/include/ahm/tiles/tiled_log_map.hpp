/// \file
/// The log map of a tiled graph, on disk as the graph is.
///
/// \code
/// ahm::tiles::write_log_map(graph, ahm::Source::at_vertex(ahm::Vertex{0}), "map", {});
/// ahm::tiles::write_rows(graph, "map", "map.csv");
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>

#include "ahm/maps/streamed_log_map.hpp"
#include "ahm/tiles/tiled_graph.hpp"

namespace ahm::tiles {

struct TiledMapOptions {
  HeatOptions heat;
  double radius = std::numeric_limits<double>::infinity();
  bool coordinates = true;  ///< false: distances alone, those of the localized map (`stream_distances`)
  std::size_t memory = std::size_t{256} << 20;  ///< bytes of the map that are in memory at a time
  Index checkpoint = 16;                        ///< bands after which a run that is killed may go on; 0: never
};

struct TiledMapSummary {
  MarchStatistics march;
  Index begun_at = 0;         ///< bands that a run before this one, which did not end, has made
  std::int64_t ok = 0;        ///< vertices with coordinates
  double farthest = 0;        ///< largest distance
  std::int64_t releases = 0;  ///< times that memory of a tile of the graph was given back
  std::int64_t spills = 0;    ///< times a part of the map left memory before it was whole
};

/// One map by march: tiles of the graph are loaded as the front reaches them, tiles of the map written when it has passed. The
/// bits are those of a marching `LogMapSolver` on the same graph in memory. The folder gets a file per tile, NUMBER.map: arrays
/// `coordinates` (2 per vertex), `distance`, `spread`, `status` (ahm::Status), of distances alone `distance` and `status`; and,
/// last of all, map.json. Where a run was killed, the next one with the same arguments goes on from its last checkpoint, and ends with
/// the same bytes.
/// @throws as `stream_log_map`; InvalidArgument (a folder with an unfinished map of something else), IoError
TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options);

/// The rows of the input as CSV: row, u, v, distance, spread, status, or row, distance, status; tile by tile, in the order of the graph,
/// without points that are not finite. As by `Surface::to_rows`, distances from one source are no less than the straight line in
/// space, below which those of the tiles may be, and rows end at the radius of the map. @throws IoError
void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv);

}  // namespace ahm::tiles
