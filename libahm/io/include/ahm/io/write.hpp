/// \file
/// Writes tables of rows.
///
/// \code
/// ahm::io::check_writable("map.csv");       // before a long computation
/// ahm::io::write("map.csv", table);         // see ahm/io/table.hpp
/// \endcode
#pragma once

#include <filesystem>
#include <span>

#include "ahm/error.hpp"
#include "ahm/io/table.hpp"

namespace ahm::io {

/// Writes a .csv, .jsonl, .ply, .pcd or .vtp file. The file appears when it is complete, or not at all (`AtomicFile`).
///
/// - CSV: the row number as `index`, then the columns. Numbers are the shortest decimals that read back to the same double; NaN is
///   "nan". No faces, no edges. Also used for a pipe or device without extension, such as /dev/stdout.
/// - JSONL: JSON lines, one object per row with `index` and the columns of a .csv by name; null for numbers that are not finite.
/// - PLY: binary little endian, or text; double, int and uchar properties; faces and edges.
/// - VTP: VTK's XML PolyData, for ParaView. Columns are point arrays; a column of three names is a vector (nx ny nz: Normals; red
///   green blue: colors); the status is stored as its code. The cells are faces, edges, or else the points.
/// - PCD: binary. x y z, intensity and curvature are floats if this loses no precision (to fit pcl::PointXYZI), else doubles;
///   nx ny nz are the floats normal_x normal_y normal_z; red green blue are packed rgb. Width, height and viewpoint come from the
///   acquisition. No faces, no edges.
/// @throws IoError with the file and the system's reason
/// @throws InvalidArgument when the columns have different lengths, a column name is invalid, or a face refers to a row that does
/// not exist
/// @param extension  selects the format independently of the file name; empty: use the extension of the file name
void write(const std::filesystem::path& path, const Table& table, const std::string& extension = {});

/// Whether `write` includes columns for viewers (`Column::for_viewers`) in such a file. True for unknown extensions.
bool writes_for_viewers(const std::filesystem::path& path, const std::string& extension = {});

/// Writes curves as lines (`l`) of an .obj file, in double precision. The file appears when it is complete, or not at all.
/// @param points  points of all curves, concatenated
/// @param begin   ascending: index of the first point of each curve; curves without points are skipped
/// @param groups  name of the group (`g`) of each curve; empty: no groups
/// @throws IoError
void write_obj_lines(const std::filesystem::path& path, std::span<const Vec3> points, std::span<const Index> begin,
                     std::span<const std::string> groups = {});

/// Checks, before a long computation, that `write` can succeed: the extension is known, and the directory exists and is writable.
/// @throws IoError
void check_writable(const std::filesystem::path& path, const std::string& extension = {});

}  // namespace ahm::io
