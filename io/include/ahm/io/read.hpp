/// \file
/// Meshes and point clouds from files.
///
/// \code
/// auto geometry = ahm::io::read("scan.pcd");
/// for (const ahm::Warning& warning : geometry.warnings) std::cerr << warning.id << '\n';
/// \endcode
#pragma once

#include <filesystem>

#include "ahm/error.hpp"
#include "ahm/io/geometry.hpp"

namespace ahm::io {

/// Reads .ply, .off, .obj, .stl, .pcd, .xyz, .txt or .csv; the extension (in any case) chooses the format.
///
/// Text numbers are read the same way in every locale and keep double precision; vertices and polygons keep the file's
/// order. A file that is cut short, lies about its counts, or holds something that is no number is refused as a whole.
/// - PLY: text or binary of either byte order; normals nx ny nz and colours red green blue (uchar) when present.
/// - PLY triangle strips become triangles; other elements are ignored with a warning.
/// - OFF: text, polygons; the normals of NOFF.
/// - OBJ: polygons, relative indices; `vn` only when numbered like the vertices.
/// - PCD: text, binary or compressed, through PCL (build option AHM_WITH_PCL).
/// - XYZ, TXT: 3 columns, or 6 with normals (or colours, when all are whole numbers up to 255). CSV: the same with
///   commas, semicolons or tabs, or columns named x, y, z (nx, ny, nz).
/// @throws IoError naming the file, the line or byte, the value, and what to do
/// @throws ResourceExhausted when memory does not suffice
Geometry read(const std::filesystem::path& path);

}  // namespace ahm::io
