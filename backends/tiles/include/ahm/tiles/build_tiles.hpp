/// \file
/// From a file of points, of any size, to tiles of the graph that `pointcloud::PointCloudSurface` builds of it: the same
/// vertices, edges, weights and transports, to the bit.
///
/// \code
/// ahm::tiles::plan_tiles("scan.ply", "tiles", {.tile_points = 500'000});
/// ahm::tiles::build_tiles("tiles", {.memory = std::size_t{2} << 30});      // killed, it goes on where it was
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

struct BuildOptions {
  std::size_t memory = std::size_t{2} << 30;  ///< bytes that a tile and its surroundings may take
  unsigned threads = 0;                       ///< 0: one per core; no result depends on it
  bool keep = false;                          ///< keep files of finished steps
  Progress progress = {};
};

/// Cuts a file of points (`io::PointStream`) along a Morton curve, reading it about eight times (text and what is compressed once), and writes the manifest last: where
/// there is none, planning begins anew.
/// @param folder  made where it does not exist
/// @throws IoError, InvalidGeometry (fewer than 3 points, non-finite ones), InvalidArgument (options; normals that are not to
/// be ignored; a folder that has been planned otherwise), ResourceExhausted (more than 2^30 points)
Manifest plan_tiles(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                    const Progress& progress = {});

/// A step of the build: of one tile, or of all together (`tile` none).
struct Step {
  std::string_view name;
  bool per_tile;
};
/// In this order: sort, index, planes, measure, cover, mollify, edges, orient, graph, finish. A step that is done is not
/// done again; those of one name may run at the same time, in processes of their own, on machines that share the folder.
const std::vector<Step>& steps();

/// Does one step. @return whether there was something to do
/// @throws InvalidArgument (no such step or tile; a step before it is not done), IoError (a tile is missing or damaged, the disk is
/// full), InvalidGeometry (a cloud too noisy for 30 neighbours; nothing but lines), ResourceExhausted (a tile and its surroundings do not fit)
bool run_step(const std::filesystem::path& folder, std::string_view name, std::optional<std::size_t> tile,
              const BuildOptions& options = {});

/// All steps that are left.
void build_tiles(const std::filesystem::path& folder, const BuildOptions& options = {});

}  // namespace ahm::tiles
