/// \file
/// Meshes and point clouds from files.
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

/// Reads .ply, .pcd, .las, .xyz, .txt, .asc, .csv, .pts, .off, .obj, .stl, .glb, .gltf, .vtp or .vtk; the extension (in any case)
/// chooses the format. Files compressed with gzip are unpacked first; theirs is the extension before .gz.
///
/// Text numbers are read the same way in every locale and keep double precision; vertices and polygons keep the file's
/// order. A file that is cut short, lies about its counts, or holds something that is no number is refused as a whole.
/// - PLY: text or binary of either byte order; normals nx ny nz and colors red green blue when present,
///   further numbers of the vertices as properties.
/// - PLY triangle strips become triangles; other elements are ignored with a warning.
/// - OFF: text, polygons; the normals of NOFF, the colors of COFF.
/// - OBJ: polygons, relative indices; `vn` only when numbered like the vertices; colors behind x y z.
/// - PCD: text, binary or compressed, through PCL (build option AHM_WITH_PCL); further fields as properties, those of several
///   values with _0, _1, ... behind their names; width, height and viewpoint as acquisition.
/// - LAS: versions 1.0 to 1.4, point formats 0 to 10, not compressed; intensity and classification as properties.
/// - XYZ, TXT, ASC, PTS, CSV: columns separated by blanks, commas, semicolons (CSV: or tabs), named x, y, z (nx, ny, nz;
///   r, g, b) or 3, 6 with normals (or colors, when all are whole numbers up to 255) or 9 with both.
/// - PTS: the fourth of 4 or 7 columns is the property intensity, the last three of 7 are colors.
/// - GLB, GLTF: the triangles and points of the scene, placed by their nodes; triangles are welded at equal positions.
/// - VTP, VTK: polygonal data; arrays of the points are normals, colors or properties, strips become triangles (VTP: build
///   option AHM_WITH_PUGIXML).
/// @throws IoError naming the file, the line or byte, the value, and what to do
/// @throws ResourceExhausted when memory does not suffice, or a file would fill more than a third of what is free when
/// unpacked
/// @param extension  of the format, whatever the file is called; empty: that of the name
Geometry read(const std::filesystem::path& path, const std::string& extension = {});

/// The same from a stream, read to its end; messages call it '-'.
/// @param extension  of the format, such as ".xyz"; empty: PLY, PCD, LAS, OFF, GLB, VTP, VTK and text STL are told by their first
/// bytes, others are refused (fault "unknown_bytes")
/// @throws as for files
Geometry read(std::istream& stream, const std::string& extension = {});

/// The same from standard input, not through std::cin, which takes errors of the system for its end.
/// @throws as for files
Geometry read_standard_input(const std::string& extension = {});

/// The files beside it that a file is read with: the buffers of a .gltf. None where it cannot be read.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path);

}  // namespace ahm::io
