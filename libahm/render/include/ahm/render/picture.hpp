/// \file
/// Pictures of results on a surface or scan, as a PNG file or an HTML page: logarithmic maps as a polar checkerboard, coordinates
/// along a curve as squares, cells in colors, and distances.
///
/// \code
/// ahm::render::Scene scene;
/// scene.points = points;                 // u, v: one per point, NaN for points without a coordinate
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

/// What determines the colors of the points.
enum class Pattern {
  polar,     ///< (u, v): rings of equal distance, sectors of equal direction
  grid,      ///< (u, v): squares, warm colors where v > 0 (left of a curve), cold ones where v < 0
  cells,     ///< labels: neighboring cells in different colors, with rings of equal distance
  distance,  ///< distance: colors of evenly increasing lightness, with a labeled color bar and lines at the rings
  none,      ///< the surface without a map
};

/// The contents of a picture. The spans are only read, and only during the call.
struct Scene {
  /// Positions, world units. Points that are not finite are skipped.
  std::span<const Vec3> points;
  /// Normals, one per point, of any length and either sign; NaN or zero if unknown. Empty: normals are estimated.
  std::span<const Vec3> normals;
  /// Polygons in CSR format: the vertices of face f are face_vertices[face_begin[f] .. face_begin[f + 1]). Both empty: a point cloud.
  std::span<const Offset> face_begin;
  std::span<const Index> face_vertices;
  /// Whether the polygons are triangles of a point cloud. A source picked on the page is then a point, not a place in a face.
  bool is_cloud = false;
  /// The map, one number per point, world units. Points with NaN are gray. Must be empty for cells.
  std::span<const double> u, v;
  /// For cells: the cell of each point. Points with a negative label, or with a distance that is not finite, are gray.
  std::span<const Index> labels;
  /// Distance of each point, world units. For cells: from the source of the cell. For `Pattern::distance`: empty means |(u, v)|.
  std::span<const double> distance;
  /// Quality of the map, one number per point (`map_quality`). Points below `reliable_quality` are hatched in gray. Empty or not finite:
  /// not hatched.
  std::span<const double> quality;
  /// 1 for points whose distance is only a lower bound (`RowLogMap::bounded`), one per point. Where their quality is not low, they are
  /// dotted. May be empty.
  std::span<const double> bounded;
  /// Position of the source, drawn as a red dot; need not be one of the points. All marks are drawn only where they are visible.
  Vec3 source{};
  /// Additional red dots, and a red polyline.
  std::span<const Vec3> dots, curve;
  /// Indices into `curve` at which a new piece of the polyline begins, ascending. Empty: one piece.
  std::span<const Index> curve_pieces;
  /// Unit vectors of the u axis, the v axis and the normal at the source; the axes are drawn as arrows.
  std::optional<std::array<Vec3, 3>> source_axes;
  /// Heading of the HTML page; not used for PNG files.
  std::string title;
  /// Red, green, blue of each point, which an HTML page can show instead of the map. May be empty.
  std::span<const std::array<std::uint8_t, 3>> colors;
  /// Additional values of the point under the pointer that an HTML page displays; each may be empty.
  struct PointDetails {
    std::span<const double> distance, spread;  ///< world units; NaN if unknown
    std::span<const Status> status;
    std::string source;  ///< the source in the format of ahm's option --source
  } details;
};

/// Options of a picture.
struct PictureOptions {
  Pattern pattern = Pattern::polar;
  /// Size of a PNG, pixels, from 16 to 8192. An HTML page fills its window.
  int width = 1600, height = 1200;
  /// Width of a distance ring or of a square, world units. Default: a round number that gives about 12 rings, 24 squares along the
  /// curve, or 4 rings per cell.
  std::optional<double> ring_width;
  /// Number of sectors; positive and even, so that the checkerboard closes.
  int sectors = 24;
  /// Direction from the center of the picture to the camera. Default: an unobstructed view of the source, or of a curve in one piece,
  /// slightly from above.
  std::optional<Vec3> view_direction;
  /// Direction that points up in the picture. Default: z for flat scans (z is by far the shortest side of the box), else y.
  std::optional<Vec3> up;
  /// Number of threads; 0: one per core. The picture does not depend on it.
  unsigned threads = 0;
};

/// Whether this build can write PNG files (requires stb).
bool can_write_png() noexcept;

/// Whether this build can write HTML pages (requires three.js).
bool can_write_html() noexcept;

/// Draws the scene in memory. Does not require a display.
/// @throws InvalidArgument for sizes, indices or options out of range; InvalidGeometry if no point is finite
Image draw_picture(const Scene& scene, const PictureOptions& options = {});

/// Draws the scene and writes a PNG file, which appears complete or not at all.
/// @throws as `draw_picture`;
///         IoError if the file cannot be written, or this build has no stb.
void write_png(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// Writes a self-contained HTML page with an interactive 3D view. Does not require a network.
/// @throws as `write_png`; Error if this build has no three.js.
void write_html(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

/// Calls `write_png` or `write_html`, depending on the extension: .png, .html or .htm (any case).
/// @throws InvalidArgument for other extensions; as `write_png` and `write_html`.
void write_picture(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options = {});

}  // namespace ahm::render
