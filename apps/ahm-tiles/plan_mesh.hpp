/// \file
/// Cuts a mesh that fits into memory into tiles.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/progress.hpp"
#include "ahm/tiles/manifest.hpp"

namespace ahm::tiles::program {

/// Options for building the surface of a mesh, as in `ahm logmap`.
struct MeshPlan {
  NonManifold non_manifold = NonManifold::error;
  polymesh::Discretization discretization = polymesh::Discretization::automatic;
  bool flips = true;
  unsigned threads = 0;

  bool is_usual() const {
    return non_manifold == NonManifold::error && discretization == polymesh::Discretization::automatic && flips;
  }
};

/// Reads a mesh, builds its surface, and writes it as built tiles.
/// @throws InvalidArgument (a file without faces; options of clouds), what reading, building and `tile_surface` throw
Manifest plan_mesh(const std::filesystem::path& input, const std::filesystem::path& folder, const TileOptions& options,
                   const MeshPlan& mesh, const Progress& progress);

}  // namespace ahm::tiles::program
