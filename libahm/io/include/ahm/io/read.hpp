/// \file
/// Reads meshes and point clouds from files.
///
/// \code
/// auto geometry = ahm::io::read("scan.pcd");
/// for (const ahm::Warning& warning : geometry.warnings) std::cerr << warning.id << '\n';
/// \endcode
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/io/geometry.hpp"

namespace ahm::io {

/// Reads .ply, .pcd, .las, .xyz, .txt, .asc, .csv, .pts, .off, .obj, .stl, .glb, .gltf, .vtp or .vtk. The extension (in any case)
/// selects the format. Files compressed with gzip are unpacked first; the extension before .gz selects their format.
///
/// Numbers in text are independent of the locale and have double precision. Vertices and polygons keep the file's order. A file
/// that is truncated, has wrong counts, or contains an invalid number is rejected as a whole. Lines of text files that are not
/// understood and not needed are skipped with one warning. Text may be UTF-8 or, after a byte order mark, UTF-16.
/// - PLY: text or binary of either byte order; normals nx ny nz and colors red green blue if present; other scalar properties of
///   the vertices become properties, lists of the vertices are ignored with a warning.
/// - PLY triangle strips become triangles; other elements are ignored with a warning.
/// - OFF: text, polygons; the normals of NOFF, the colors of COFF.
/// - OBJ: polygons, relative indices; `vn` only if normals and vertices have the same numbers; colors after x y z.
/// - PCD: text, binary or compressed, through PCL (build option AHM_WITH_PCL). Other fields become properties; fields of several
///   values get the suffixes _0, _1, .... Width, height and viewpoint become the acquisition.
/// - LAS: versions 1.0 to 1.4, point formats 0 to 10, not compressed; intensity, classification and extra bytes that the file
///   describes become properties.
/// - XYZ, TXT, ASC, PTS, CSV: columns separated by blanks, commas, semicolons (CSV: or tabs). Named columns: x, y, z (nx, ny, nz;
///   r, g, b). Unnamed: 3 columns, 6 with normals (or colors, if all are whole numbers up to 255), 9 with both. Other columns of
///   numbers become properties, without a name column_4, column_5, ....
/// - PTS: the fourth of 4 or 7 columns is the property intensity; the last three of 7 are colors.
/// - GLB, GLTF: the triangles and points of the scene, transformed by their nodes; triangles are welded at equal positions.
/// - VTP, VTK: polygonal data; point arrays become normals, colors or properties; strips become triangles (VTP: build option
///   AHM_WITH_PUGIXML).
/// @throws IoError with the file, the line or byte, the value, and what to do
/// @throws ResourceExhausted if there is not enough memory, or an unpacked file would use more than a third of the free memory
/// @param extension  selects the format independently of the file name; empty: use the extension of the file name
Geometry read(const std::filesystem::path& path, const std::string& extension = {});

/// Reads a mesh or point cloud from a stream, to its end; messages call it '-'.
/// @param extension  selects the format, for example ".xyz". If empty, the first bytes identify PLY, PCD, LAS, OFF, GLB, VTP,
/// VTK and text STL; other formats are rejected (fault "unknown_bytes")
/// @throws as `read` of a file
Geometry read(std::istream& stream, const std::string& extension = {});

/// Reads a mesh or point cloud from standard input. Does not use std::cin, which reports system errors as the end of the stream.
/// @throws as `read` of a file
Geometry read_standard_input(const std::string& extension = {});

/// Other files that a file refers to: the buffers of a .gltf. Empty if the file cannot be read.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path);

}  // namespace ahm::io
