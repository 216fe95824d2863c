/// \file
/// Rows to files.
///
/// \code
/// ahm::io::check_writable("map.csv");       // before a long computation
/// ahm::io::write("map.csv", table);         // see ahm/io/table.hpp
/// \endcode
#pragma once

#include <filesystem>

#include "ahm/error.hpp"
#include "ahm/io/table.hpp"

namespace ahm::io {

/// Writes a .csv, .ply or .pcd; the file appears when it is complete, or not at all (`AtomicFile`).
///
/// - CSV: the number of the row as `index`, then the columns: shortest decimals that read back to the same double, "nan"
///   for NaN. No faces, no edges. Also chosen for a pipe or device without extension, such as /dev/stdout.
/// - PLY: binary little endian, or text: double, int and uchar properties, the faces and the edges.
/// - PCD: binary, through PCL; x y z as float where that loses nothing (so that pcl::PointXYZ fits), else as double;
///   nx ny nz as float normal_x normal_y normal_z; no faces, no edges.
/// @throws IoError naming the file and the system's reason
/// @throws InvalidArgument when the columns have different lengths, a name is none, or a face names a row that is not
/// there
void write(const std::filesystem::path& path, const Table& table);

/// Tells before a long computation whether `write` can work: the extension is known, the directory exists and is
/// writable.
/// @throws IoError
void check_writable(const std::filesystem::path& path);

}  // namespace ahm::io
