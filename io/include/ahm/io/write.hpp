/// \file
/// Log maps to files.
///
/// \code
/// ahm::io::Table table;
/// table.points = geometry.points;
/// table.u = u; table.v = v; table.distance = distance; table.angle = angle;   // n numbers each
/// table.status = map.status();
/// ahm::io::write("map.csv", table);
/// \endcode
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// A further column of numbers.
struct Column {
  std::string name;                ///< letters, digits and _
  std::span<const double> values;  ///< n; where the status is not ok, NaN is written
};

/// One row per input vertex, in input order. Views only: the data must outlive the call.
struct Table {
  std::span<const Vec3> points;          ///< n
  std::span<const Vec3> normals;         ///< empty or n; NaN where there is none
  std::span<const double> u;             ///< empty (no such column) or n, first coordinate
  std::span<const double> v;             ///< empty or n, second coordinate
  std::span<const double> distance;      ///< empty or n, e.g. the length of (u, v)
  std::span<const double> angle;         ///< empty or n, radians
  std::span<const Status> status;        ///< n; where it is not ok, u, v, distance and angle are written as NaN
  std::span<const Offset> face_begin;    ///< empty or faces + 1
  std::span<const Index> face_vertices;  ///< vertex numbers in [0, n)
  std::vector<Column> further = {};      ///< come after the status
};

/// Writes a .csv, .ply or .pcd; the file appears when it is complete, or not at all (`AtomicFile`).
///
/// - CSV: `index,x,y,z,u,v,distance,angle,status` and further columns, shortest decimals that read back to the same double, "nan" for NaN,
///   status as a word. Also chosen for a pipe or device without extension, such as /dev/stdout.
/// - PLY: binary little endian; doubles x y z, nx ny nz when given, u v distance angle, uchar status (codes in the
/// comments),
///   and the faces.
/// - PCD: binary, through PCL; x y z as float where that loses nothing (so that pcl::PointXYZ fits), else as double;
///   normal_x normal_y normal_z as float, u v distance angle as double, status as one byte; no faces.
/// @throws IoError naming the file and the system's reason
/// @throws InvalidArgument when the lengths of the table do not fit together or a face names a vertex that is not there
void write(const std::filesystem::path& path, const Table& table);

/// Tells before a long computation whether `write` can work: the extension is known, the directory exists and is
/// writable.
/// @throws IoError
void check_writable(const std::filesystem::path& path);

}  // namespace ahm::io
