/// \file
/// What a file holds: points, perhaps normals and colors, perhaps polygons.
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
#include <vector>

#include "ahm/report.hpp"
#include "ahm/types.hpp"

namespace ahm::io {

/// A number per point that is neither position, normal nor color.
struct Property {
  std::string name;            ///< "intensity", "classification"
  std::vector<double> values;  ///< n
};

/// Whence the points of a PCD file were seen, and in which picture.
struct Acquisition {
  std::size_t width = 0, height = 1;  ///< point i is pixel i % width of line i / width; height 1: there is no picture
  Vec3 position{};                    ///< of the sensor
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< of the sensor: a quaternion w, x, y, z
};

/// Points and polygons as they stand in a file: same order, same precision, nothing merged, dropped or checked for
/// shape.
struct Geometry {
  std::vector<Vec3> points;                         ///< n; NaN and infinity are passed through as stored
  std::vector<Vec3> normals;                        ///< empty or n, not normalized
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< empty or n; red, green, blue
  std::vector<Property> properties;
  std::optional<Acquisition> acquisition;  ///< width times height is n
  std::vector<Offset> face_begin;          ///< empty (cloud) or faces + 1; face f = [face_begin[f], face_begin[f + 1])
  std::vector<Index> face_vertices;        ///< vertex numbers, each in [0, n)
  std::string format;                      ///< for messages, e.g. "PLY binary little endian"
  /// What was ignored, or taken for something: goes_on_after_faces, goes_on_after_elements (the rest of the file),
  /// element_ignored (its name), header_lines_ignored (their number), statements_ignored (their number; the first of
  /// their keywords), colors_unknown (neither fractions of 1 nor whole levels), colors_not_packed, normals_not_by_vertex,
  /// vertex_extras (numbers behind x, y, z), columns_as_colors (the numbers of the first and the last), columns_ignored
  /// (the number of the last; from 4), column_ignored (its name: it holds what is no number), lines_ignored (the number of sets of lines).
  std::vector<Warning> warnings;

  std::size_t face_count() const noexcept { return faces().size(); }
  FaceList faces() const noexcept { return {face_begin, face_vertices}; }
  /// The vertex numbers of polygon `face` < face_count().
  std::span<const Index> face(std::size_t face) const noexcept { return faces()[face]; }
};

}  // namespace ahm::io
