/// \file
/// An atlas: the surface cut into geodesic Voronoi cells, each flattened by the log map from its source (Fig. 18).
///
/// \code
/// auto sources = ahm::farthest_points(graph, ahm::Vertex{0}, 20);
/// ahm::Atlas atlas = ahm::make_atlas(solver, sources, {face_begin, face_vertices});
/// for (ahm::Index f : atlas.charts[3].faces)
///   for (ahm::Offset c = face_begin[f]; c < face_begin[f + 1]; ++c) use(atlas.corner(c));   // (u, v) of each corner
/// \endcode
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ahm/applications/any_solver.hpp"
#include "ahm/applications/distortion.hpp"
#include "ahm/image.hpp"

namespace ahm {

/// A connected piece of the surface with coordinates from one source.
struct Chart {
  Index source;              ///< index of the source in `Atlas::sources`
  std::vector<Index> faces;  ///< in ascending order
};

struct Atlas {
  std::vector<Vertex> sources;       ///< vertices from which the charts are mapped
  std::vector<Chart> charts;         ///< sorted by source
  std::vector<Index> chart_of_face;  ///< chart of each face; -1: a corner has no coordinates, e.g. in a component
                                     ///< without a source
  /// (u, v) of every corner, world units, in the frame of the chart's source: corners x 2; NaN in faces without a chart. If
  /// most faces of a chart are clockwise in the map, v is negated, so that faces listed counter-clockwise are
  /// counter-clockwise in the chart.
  std::vector<double> coordinates;

  Vec2 corner(Offset c) const { return {coordinates[2 * c], coordinates[2 * c + 1]}; }
};

/// Cuts the surface into geodesic Voronoi cells and flattens them. The candidates for a face are the sources nearest to its
/// corners (`voronoi_cells`). The face belongs to the candidate with the smallest mean distance to its corners (Sec. 5 of
/// the paper). A corner on the border of two charts has different coordinates in each.
///
/// Faces that are cut off from the rest of their cell join the neighboring chart with which they share most sides, if the
/// map of that chart covers them. Otherwise they become a chart of their own. Each map is computed only around its chart:
/// memory O(n + corners) for any number of sources.
/// @param maps     a `LogMapSolver`, a `PolarMapSolver` or `ExactGeodesics`; the latter makes cells and charts exact over
/// the flat faces
/// @param sources  vertices; the charts have their order
/// @param faces    faces of the graph's vertices, in any order
/// @throws InvalidArgument (dimension, sources, faces), as `AnySolver::coordinates`
Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces);

struct RefineOptions {
  double max_distortion = 2;       ///< largest distortion of a good triangle, which also is not flipped; > 1
  double share = 0.01;             ///< share of a chart's area that may be in bad triangles; in [0, 1)
  std::size_t max_sources = 1000;  ///< maximum number of sources
};

/// Makes an atlas and adds sources until all charts are good, or until there are `max_sources`. Charts are bad where a cell
/// closes around a handle, a limb or a sharp feature. In every bad chart the corner of bad triangles that is farthest from
/// the source becomes another source; then the surface is cut again. Components without a source get one.
/// @param positions  n positions of the graph's vertices, world units
/// @throws InvalidArgument (also positions, options), as `AnySolver::coordinates`
Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces,
                 std::span<const Vec3> positions, const RefineOptions& refine);

/// Distortion of an atlas; faces are cut into fans of triangles.
struct AtlasDistortion {
  DistortionSummary all;
  std::vector<DistortionSummary> charts;
};

/// Distortion of all faces and of each chart.
/// @param positions  n positions of the graph's vertices, world units
/// @throws InvalidArgument (faces that do not match the atlas, indices)
AtlasDistortion distortion(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions);

/// Bounding rectangle of smallest area of a chart. In the axes rotated by `turn` the chart fills [low, high] in both
/// directions.
struct ChartBox {
  Vec2 turn{1, 0};  ///< cosine and sine: x = c u + s v, y = -s u + c v
  Vec2 low{}, high{};
};

/// The box of every chart; its longer side lies along x.
/// @throws InvalidArgument (faces that do not match the atlas)
std::vector<ChartBox> chart_boxes(const Atlas& atlas, const FaceList& faces);

struct PackOptions {
  int size = 2048;  ///< side of the square texture, texels; 16 to 32768
  int margin = 4;   ///< empty texels around each chart and along the border of the texture; >= 0
};

/// Rectangle of a chart without its margin, in texels from the lower left corner of the texture.
struct TextureBox {
  int x, y, width, height;
};

struct TextureAtlas {
  int size = 0, margin = 0;
  double scale = 0;                 ///< texels per world unit, equal for all charts
  double filled = 0;                ///< share of the texture that the boxes cover
  std::vector<TextureBox> boxes;    ///< one per chart, at least `margin` texels apart
  std::vector<double> coordinates;  ///< corners x 2 in [0, 1], (0, 0) at the lower left corner; NaN in faces without a
                                    ///< chart
};

/// Whether this build includes stb, which `pack` requires.
bool can_pack() noexcept;

/// Rotates every chart to its bounding rectangle of smallest area and packs the rectangles as large as they fit, at one
/// scale (stb_rect_pack). The longer sides are all horizontal or all vertical.
/// @throws InvalidArgument (options; too many charts for the texture), Error (built without stb)
TextureAtlas pack(const Atlas& atlas, const FaceList& faces, const PackOptions& options = {});

/// Fills every chart with a checkerboard in a hue of its own, aligned with its box. Half of each margin is painted, too.
/// @param square  side of a square, texels; 0: 64 squares along the side of the texture
Image checkerboard(const TextureAtlas& atlas, int square = 0);

}  // namespace ahm
