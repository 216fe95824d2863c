/// \file
/// Pictures of what was found on a surface or scan: a logarithmic map as a polar checkerboard, coordinates along a curve
/// as squares, cells in colors. As a PNG file or as one HTML page.
///
/// \code
/// ahm::render::Scene scene;
/// scene.points = points;                 // with u, v per point, NaN where there is no coordinate
/// scene.u = u, scene.v = v;
/// scene.source = points[source];
/// ahm::render::write_picture("map.png", scene);
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "ahm/image.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/types.hpp"

namespace ahm::render {

/// What the points are painted by.
enum class Pattern {
  polar,     ///< (u, v): rings of equal distance, sectors of equal direction
  grid,      ///< (u, v): squares, warm colors where v > 0 (left of a curve), cold ones where v < 0
  cells,     ///< labels: neighbouring cells in different colors, with rings of equal distance
  distance,  ///< distance: colors of evenly rising lightness, with a bar that tells the numbers, and lines at the rings
  none,      ///< the surface alone
};

/// What is shown. The spans are only read, and only during the call.
struct Scene {
  /// Positions, world units. Points that are not finite are left out.
  std::span<const Vec3> points;
  /// One per point, any length, either sign; NaN or zero where unknown. Empty: estimated.
  std::span<const Vec3> normals;
  /// Polygons as CSR: the vertices of face f are face_vertices[face_begin[f] .. face_begin[f + 1]). Both empty: a
  /// cloud.
  std::span<const Offset> face_begin;
  std::span<const Index> face_vertices;
  /// The map, one number per point in world units; NaN where there is no coordinate (painted gray). Empty for cells.
  std::span<const double> u, v;
  /// For cells: the number of each point's cell, and the distance from the cell's source in world units. Points are
  /// gray where the one is negative or the other is not finite.
  std::span<const Index> labels;
  /// For cells, and for `Pattern::distance`, where empty means |(u, v)|.
  std::span<const double> distance;
  /// How far the map can be trusted, one number per point (`map_quality`): hatched in gray where it is below
  /// `trusted_quality`. Not finite, or empty: trusted.
  std::span<const double> quality;
  /// Position of the source (need not be one of the points), a red dot; drawn where nothing stands before it, as all marks are.
  Vec3 source{};
  /// Further red dots, and a polyline in red.
  std::span<const Vec3> dots, curve;
  /// Where a further piece of the polyline begins: points of `curve`, ascending. Empty: it is in one piece.
  std::span<const Index> curve_pieces;
  /// Unit axes u, v and normal at the source; u and v are drawn as arrows.
  std::optional<std::array<Vec3, 3>> source_axes;
  /// Heading of the HTML page; a PNG has none.
  std::string title;
  /// Red, green, blue per point, which an HTML page can show instead. May be empty.
  std::span<const std::array<std::uint8_t, 3>> colors;
  /// What an HTML page tells of the point under the pointer besides u, v and quality; each may be empty.
  struct Told {
    std::span<const double> distance, spread;  ///< world units, NaN where unknown
    std::span<const Status> status;
    std::string source;  ///< as the program's --source takes it
  } told;
};

/// How it is shown.
struct PictureOptions {
  Pattern pattern = Pattern::polar;
  /// Pixels of a PNG, 16 to 8192 each. An HTML page fills its window.
  int width = 1600, height = 1200;
  /// Width of a distance ring, or of a square, in world units. Default: the round number that gives about 12 rings, 24
  /// squares along the curve, or 4 rings per cell.
  std::optional<double> ring_width;
  /// Number of angle sectors; even and positive, so that the checkerboard closes.
  int sectors = 24;
  /// From the picture's center towards the camera. Default: a free view of the source, or of a curve in one piece,
  /// slightly from above.
  std::optional<Vec3> view_direction;
  /// Upwards in the picture. Default: z for flat scans (z is by far the thinnest side of the box), else y.
  std::optional<Vec3> up;
  /// Threads; 0: one per core. The picture does not depend on it.
  unsigned threads = 0;
};

/// Whether this build can write PNG files (needs stb).
bool can_write_png() noexcept;

/// Whether this build can write HTML pages (needs three.js).
bool can_write_html() noexcept;

/// Draws the scene in memory; no display is needed.
/// @throws InvalidArgument for sizes, indices or options out of range; InvalidGeometry if no point is finite
Image draw_picture(const Scene& scene, const PictureOptions& options = {});

/// Writes `draw_picture` as a PNG file, which appears complete or not at all.
/// @throws as `draw_picture`;
///         IoError if the file cannot be written, or this build has no stb.
void write_png(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// Writes one self-contained HTML page that can be turned and zoomed, and needs no network.
/// @throws as `write_png`; Error if this build has no three.js.
void write_html(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// `write_png` or `write_html` by the ending .png, .html or .htm (any case).
/// @throws InvalidArgument for another ending, else as the two.
void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

}  // namespace ahm::render
