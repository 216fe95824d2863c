/// \file
/// Tiles of a mesh that fits into memory.
#pragma once

#include <filesystem>

#include "ahm/distributed/manifest.hpp"
#include "ahm/progress.hpp"

namespace ahm::distributed::program {

/// Reads a mesh, builds its surface as `ahm logmap` does, and writes its tiles, built.
/// @throws InvalidArgument (a file without faces; options of clouds), what reading, building and `tile_surface` throw
Manifest plan_mesh(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                   const Progress& progress);

}  // namespace ahm::distributed::program
