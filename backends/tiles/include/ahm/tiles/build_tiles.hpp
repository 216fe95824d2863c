/// \file
/// Builds tiles of the graph of a point cloud of any size. Vertices, edges, weights and transports have the same bits as those of
/// `pointcloud::PointCloudSurface`.
///
/// \code
/// ahm::tiles::plan_tiles("scan.ply", "tiles", {.tile_points = 500'000});
/// ahm::tiles::build_tiles("tiles", {.memory = std::size_t{2} << 30});      // resumes a killed build
/// const ahm::tiles::TiledGraph graph("tiles", std::size_t{1} << 30);
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/progress.hpp"
#include "ahm/tiles/manifest.hpp"

namespace ahm::tiles {

/// Options of the build.
struct BuildOptions {
  std::size_t memory = std::size_t{2} << 30;  ///< limit for a tile with its surroundings, bytes
  unsigned threads = 0;                       ///< 0: one per core; no result depends on it
  bool keep = false;                          ///< keep intermediate files of finished steps
  Progress progress = {};
};

/// Cuts a file of points (`io::PointStream`) into tiles along a Morton curve. Reads the file about eight times, text and compressed
/// files once. Writes the manifest last; without a manifest, planning starts again.
/// @param folder  created if it does not exist
/// @throws IoError, InvalidGeometry (fewer than 3 points; non-finite points), InvalidArgument (options; normals without
/// `ignore_normals`; a folder with tiles), ResourceExhausted (more than 2^30 points)
Manifest plan_tiles(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                    const Progress& progress = {});

/// A step of the build, which runs for each tile, or once for all tiles.
struct Step {
  std::string_view name;
  bool per_tile;
};
/// The steps in their order: sort, index, planes, measure, cover, mollify, edges, orient, graph, finish. A finished step is not
/// repeated. A step of several tiles may run in several processes at the same time, on machines that share the folder.
const std::vector<Step>& steps();

/// Runs one step. @return false if it was already finished
/// @param tile  number of the tile; none for steps of all tiles
/// @throws InvalidArgument (no such step or tile; an earlier step is not finished), IoError (a tile is missing or damaged; the disk is
/// full), InvalidGeometry (too noisy for 30 neighbors; all points on lines), ResourceExhausted (a tile with its surroundings does not
/// fit the memory)
bool run_step(const std::filesystem::path& folder, std::string_view name, std::optional<std::size_t> tile,
              const BuildOptions& options = {});

/// Runs all steps that are not finished. @throws as `run_step`
void build_tiles(const std::filesystem::path& folder, const BuildOptions& options = {});

}  // namespace ahm::tiles
