/// \file
/// Rows to files.
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

/// Writes a .csv, .jsonl, .ply, .pcd or .vtp; the file appears when it is complete, or not at all (`AtomicFile`).
///
/// - CSV: the number of the row as `index`, then the columns: shortest decimals that read back to the same double, "nan"
///   for NaN. No faces, no edges. Also chosen for a pipe or device without extension, such as /dev/stdout.
/// - JSONL: JSON lines, one object per row with `index` and the columns of a .csv by their names, null for what is no
///   finite number.
/// - PLY: binary little endian, or text: double, int and uchar properties, the faces and the edges.
/// - VTP: VTK's XML PolyData, for ParaView: columns as arrays over the points, those of three names as vectors (nx ny nz:
///   Normals; red green blue: colors), status by its numbers; faces, edges, or else the points as cells.
/// - PCD: binary; x y z, intensity and curvature as float where that loses nothing (so that pcl::PointXYZI fits), else as
///   double; nx ny nz as float normal_x normal_y normal_z, red green blue as packed rgb; width, height and viewpoint of
///   the acquisition; no faces, no edges.
/// @throws IoError naming the file and the system's reason
/// @throws InvalidArgument when the columns have different lengths, a name is none, or a face names a row that is not
/// there
/// @param extension  of the format, whatever the file is called; empty: that of the name
void write(const std::filesystem::path& path, const Table& table, const std::string& extension = {});

/// Whether `write` puts columns that are for viewers only into such a file; true of files that it does not write.
bool writes_for_viewers(const std::filesystem::path& path, const std::string& extension = {});

/// Writes an .obj with curves as its lines (`l`), in doubles; the file appears when it is complete, or not at all.
/// @param points  of all curves, one behind the other
/// @param begin   rising: where each begins among them; curves without points have no line
/// @throws IoError
void write_obj_lines(const std::filesystem::path& path, std::span<const Vec3> points, std::span<const Index> begin);

/// Tells before a long computation whether `write` can work: the extension is known, the directory exists and is
/// writable.
/// @throws IoError
void check_writable(const std::filesystem::path& path, const std::string& extension = {});

}  // namespace ahm::io
