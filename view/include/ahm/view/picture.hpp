/// \file
/// Pictures of a logarithmic map: a surface or scan painted with a polar checkerboard, as a PNG file or as one HTML
/// page.
///
/// \code
/// ahm::view::Scene scene;
/// scene.points = points;                 // with u, v per point, NaN where there is no coordinate
/// scene.u = u, scene.v = v;
/// scene.source = points[source];
/// ahm::view::write_picture("map.png", scene);
/// \endcode
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "ahm/types.hpp"

namespace ahm::view {

/// What is shown. The spans are only read, and only during the call.
struct Scene {
  /// Positions, outside units. Points that are not finite are left out.
  std::span<const Vec3> points;
  /// One per point, any length, either sign; NaN or zero where unknown. Empty: estimated.
  std::span<const Vec3> normals;
  /// Polygons as CSR: the vertices of face f are face_vertices[face_begin[f] .. face_begin[f + 1]). Both empty: a
  /// cloud.
  std::span<const Offset> face_begin;
  std::span<const Index> face_vertices;
  /// The map, one number per point in outside units; NaN where there is no coordinate (painted grey).
  std::span<const double> u, v;
  /// Position of the source (need not be one of the points).
  Vec3 source{};
  /// Unit axes u, v and normal at the source; u and v are drawn as arrows.
  std::optional<std::array<Vec3, 3>> source_axes;
  /// Heading of the HTML page; a PNG has none.
  std::string title;
};

/// How it is shown.
struct PictureOptions {
  /// Pixels of a PNG, 16 to 8192 each. An HTML page fills its window.
  int width = 1600, height = 1200;
  /// Width of a distance ring in outside units. Default: the round number that gives about 12 rings.
  std::optional<double> ring_width;
  /// Number of angle sectors; even and positive, so that the checkerboard closes.
  int sectors = 24;
  /// From the picture's centre towards the camera. Default: a free view of the source, slightly from above.
  std::optional<Vec3> view_direction;
  /// Upwards in the picture. Default: z for flat scans (z is by far the thinnest side of the box), else y.
  std::optional<Vec3> up;
};

/// Whether this build can write PNG files (needs OSMesa and stb).
bool can_write_png() noexcept;

/// Whether this build can write HTML pages (needs three.js).
bool can_write_html() noexcept;

/// Renders the scene in memory (no display needed) and writes a PNG file; the file appears complete or not at all.
/// @throws InvalidArgument for sizes, indices or options out of range; InvalidGeometry if no point is finite;
///         IoError if the file cannot be written; Error if this build has no OSMesa.
void write_png(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// Writes one self-contained HTML page that can be turned and zoomed, and needs no network.
/// @throws as `write_png`; Error if this build has no three.js.
void write_html(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// `write_png` or `write_html` by the ending .png, .html or .htm (any case).
/// @throws InvalidArgument for another ending, else as the two.
void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

}  // namespace ahm::view
