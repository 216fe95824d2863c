/// \file
/// Tiles of a surface that was built in memory: maps of it out of core and by ranks.
///
/// \code
/// const auto surface = ahm::trimesh::TriangleMeshSurface::build(points, triangles);
/// ahm::tiles::tile_surface(surface, "mesh.ply", "tiles");
/// const ahm::tiles::TiledGraph graph("tiles", std::size_t{1} << 30);
/// \endcode
#pragma once

#include <filesystem>
#include <string>

#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/tiles/manifest.hpp"

namespace ahm::tiles {

/// Writes the graph of a surface as tiles that are built, its vertices along a Morton curve of their positions, and the manifest
/// last. Maps of the tiles are those of the surface to rounding, since nothing but the order of the vertices is another.
/// @param input        what the surface was made of, for messages
/// @param folder       made where it does not exist
/// @param tile_points  vertices per tile, at least 100
/// @throws InvalidArgument (tile_points; a surface without positions; a folder that holds tiles), IoError
Manifest tile_surface(const Surface& surface, const std::string& input, const std::filesystem::path& folder,
                      Index tile_points = TileOptions().tile_points, const Progress& progress = {});

}  // namespace ahm::tiles
