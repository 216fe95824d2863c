/// \file
/// The log map of a tiled graph, with tiles on disk.
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

/// Options of a map over tiles.
struct TiledMapOptions {
  HeatOptions heat;
  double radius = std::numeric_limits<double>::infinity();  ///< as `MapOptions::radius`, world units
  bool coordinates = true;                      ///< false: only the distances of the localized map (`stream_distances`)
  std::size_t memory = std::size_t{256} << 20;  ///< limit for tiles of the map in memory, bytes
  Index checkpoint = 16;  ///< bands between checkpoints, from which a killed run can resume; 0: none
};

/// Figures of a finished map.
struct TiledMapSummary {
  MarchStatistics march;
  Index begun_at = 0;         ///< bands that an earlier, unfinished run had solved
  std::int64_t ok = 0;        ///< vertices with coordinates
  double farthest = 0;        ///< largest distance
  std::int64_t releases = 0;  ///< number of times that memory of a tile of the graph was released
  std::int64_t spills = 0;    ///< number of times that an incomplete tile of the map was moved to disk
};

/// Makes one map by a march. Loads tiles of the graph when the front reaches them, and writes tiles of the map when it has passed. The
/// result has the same bits as a marching `LogMapSolver` on the same graph in memory. Writes one file per tile, NUMBER.map, with the
/// arrays `coordinates` (2 per vertex), `distance`, `spread`, `status` (`ahm::Status`), or without coordinates `distance` and `status`.
/// Writes map.json last. After a killed run, a run with the same arguments resumes from the last checkpoint and writes the same bytes.
/// @throws as `stream_log_map`; InvalidArgument (a folder with an unfinished map of other inputs), IoError
TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options);

/// Writes the rows of the input as CSV: row, u, v, distance, spread, status; without coordinates row, distance, status. Writes tile by
/// tile in the order of the graph, without points that are not finite. As in `Surface::to_rows`, distances from a single source are at
/// least the straight-line distance in space, and rows beyond the radius get `beyond_radius`. @throws IoError
void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv);

}  // namespace ahm::tiles
