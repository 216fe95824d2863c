/// \file
/// Tiles of a surface that was built in memory, for maps out of core or by the ranks of an MPI run.
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

/// Writes the graph of a surface as built tiles. Orders the vertices along a Morton curve, and writes the manifest last. Maps of the
/// tiles equal those of the surface up to rounding, because only the order of the vertices differs.
/// @param input        name of the input, for messages
/// @param folder       created if it does not exist
/// @param tile_points  vertices per tile, >= 100
/// @throws InvalidArgument (tile_points; a surface without positions; a folder with tiles), IoError
Manifest tile_surface(const Surface& surface, const std::string& input, const std::filesystem::path& folder,
                      Index tile_points = TileOptions().tile_points, const Progress& progress = {});

}  // namespace ahm::tiles
