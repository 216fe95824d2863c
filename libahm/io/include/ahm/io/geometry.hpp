/// \file
/// The contents of a file: points, and optionally normals, colors and polygons.
///
/// \code
/// ahm::io::Geometry g = ahm::io::read("bunny.ply");
/// for (std::size_t f = 0; f < g.face_count(); ++f) use(g.face(f));   // vertex numbers of polygon f
/// \endcode
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/report.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// A scalar attribute of the points, other than positions, normals and colors.
struct Property {
  std::string name;            ///< for example "intensity" or "classification"
  std::vector<double> values;  ///< n values
};

/// Pose of the sensor of a PCD file, and size of its range image.
struct Acquisition {
  std::size_t width = 0, height = 1;              ///< point i is pixel i % width of row i / width; height 1: no image
  Vec3 position{};                                ///< position of the sensor
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< orientation of the sensor: a quaternion w, x, y, z
};

/// Points and polygons of a file, in the file's order and precision. Nothing is merged or removed, and shapes are not checked.
struct Geometry {
  std::vector<Vec3> points;                         ///< n points; may contain NaN and infinity, as in the file
  std::vector<Vec3> normals;                        ///< empty or n, not normalized
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< empty or n; red, green, blue in [0, 255]
  std::vector<Property> properties;
  std::optional<Acquisition> acquisition;  ///< width * height is n
  std::vector<Offset> face_begin;          ///< empty (cloud) or faces + 1; face f is [face_begin[f], face_begin[f + 1])
  std::vector<Index> face_vertices;        ///< vertex numbers, each in [0, n)
  std::string format;                      ///< for messages, e.g. "PLY binary little endian"
  /// Data that was ignored or interpreted. Identifiers, with their values and names in parentheses:
  /// - data_after_faces, data_after_elements: the rest of the file is ignored
  /// - lines_skipped (number of lines that are not understood, number of the first one; its text in quotes)
  /// - no_end (name of the missing end): the file may be cut short
  /// - element_ignored (name of the element), list_ignored (name of a list of the vertices)
  /// - bytes_ignored (number of bytes per point without a description)
  /// - colors_unknown: colors are neither fractions of 1 nor whole levels; colors_not_packed
  /// - normals_not_by_vertex; vertex_extras: numbers after x, y, z are ignored
  /// - columns_as_colors (numbers of the first and the last column)
  /// - columns_unnamed (numbers of the first and the last column): properties column_4, column_5, ...
  /// - column_ignored (its name): it contains other data than numbers
  /// - lines_ignored (number of sets of lines)
  std::vector<Warning> warnings;

  std::size_t face_count() const noexcept { return faces().size(); }
  FaceList faces() const noexcept { return {face_begin, face_vertices}; }
  /// The vertex numbers of polygon `face` < face_count().
  std::span<const Index> face(std::size_t face) const noexcept { return faces()[face]; }
};

/// The names of the columns: x, y, z, and the properties.
std::vector<std::string> column_names(const Geometry& geometry);
/// The values of a column, one per point. None: there is no such column.
std::optional<std::vector<double>> column(const Geometry& geometry, std::string_view name);

}  // namespace ahm::io
