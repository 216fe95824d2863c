/// \file
/// The log map of a tiled graph, on disk as the graph is.
///
/// \code
/// ahm::distributed::write_log_map(graph, ahm::Source::at_vertex(ahm::Vertex{0}), "map", {});
/// ahm::distributed::write_rows(graph, "map", "map.csv");
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>

#include "ahm/distributed/tiled_graph.hpp"
#include "ahm/maps/streamed_log_map.hpp"

namespace ahm::distributed {

struct TiledMapOptions {
  HeatOptions heat;  ///< of order 1
  double radius = std::numeric_limits<double>::infinity();
  std::size_t memory = std::size_t{256} << 20;  ///< bytes of the map that are in memory at a time
};

struct TiledMapSummary {
  MarchStatistics march;
  std::int64_t ok = 0;        ///< vertices with coordinates
  double farthest = 0;        ///< largest distance
  std::int64_t releases = 0;  ///< times that memory of a tile of the graph was given back
  std::int64_t spills = 0;    ///< times a part of the map left memory before it was whole
};

/// One map by march: tiles of the graph are loaded as the front reaches them, tiles of the map written when it has passed. The
/// bits are those of a marching `LogMapSolver` on the same graph in memory. The folder gets a file per tile, NUMBER.map: arrays
/// `coordinates` (2 per vertex), `distance`, `spread`, `status` (ahm::Status); and, last of all, map.json.
/// @throws as `stream_log_map`; IoError
TiledMapSummary write_log_map(const TiledGraph& graph, const Source& source, const std::filesystem::path& folder,
                              const TiledMapOptions& options);

/// All rows of the input as CSV: row, u, v, distance, spread, status; tile by tile, in the order of the graph. @throws IoError
void write_rows(const TiledGraph& graph, const std::filesystem::path& folder, const std::filesystem::path& csv);

}  // namespace ahm::distributed
