/// \file
/// An atlas: the surface cut into geodesic Voronoi cells, each flattened by the log map of its own source (Fig. 18).
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
  Index source;              ///< its number in `Atlas::sources`
  std::vector<Index> faces;  ///< in ascending order
};

struct Atlas {
  std::vector<Vertex> sources;       ///< where the charts were seen from
  std::vector<Chart> charts;         ///< in the order of their sources
  std::vector<Index> chart_of_face;  ///< -1: a corner has no coordinates, e.g. in a component without a source
  /// (u, v) of every corner, world units, in the frame of the chart's source; corners x 2, NaN without a chart.
  /// Charts whose source sees the surface from behind are mirrored: v is negated, so that faces given counter-clockwise
  /// are so.
  std::vector<double> coordinates;

  Vec2 corner(Offset c) const { return {coordinates[2 * c], coordinates[2 * c + 1]}; }
};

/// Cuts the surface into cells and flattens them. A face belongs to the source from which its corners are nearest on
/// average (Sec. 5 of the paper), among the sources nearest to a corner (`voronoi_cells`). Corners at a border
/// have other coordinates in each chart.
///
/// Faces cut off from the rest of their cell go to the neighbouring chart with which they share most sides, where its
/// source knows them, else they are charts of their own. Every map is made on the surroundings of its chart alone: memory
/// O(n + corners), whatever the number of sources.
/// @param maps     a `LogMapSolver`, or `ExactGeodesics`: cells and charts are then exact over the flat faces
/// @param sources  vertices; their order is that of the charts
/// @param faces    of the graph's vertices, in any order
/// @throws InvalidArgument (dimension, sources, faces), as `AnySolver::coordinates`
Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces);

struct RefineOptions {
  double max_distortion = 2;       ///< of a good triangle, which is not flipped; > 1
  double share = 0.01;             ///< of a chart's area that need not be good; in [0, 1)
  std::size_t max_sources = 1000;  ///< no more are added
};

/// The same with as many further sources as it takes to make all charts good. They are not where a cell closes around a
/// handle, a limb or a sharp feature: of every such chart the corner of bad triangles that is farthest from the source
/// becomes another source, and the surface is cut anew, until nothing is to be added. Components without a source get
/// one.
/// @param positions  n, of the graph's vertices, world units
/// @throws InvalidArgument (also positions, options), as `AnySolver::coordinates`
Atlas make_atlas(const AnySolver& maps, std::span<const Vertex> sources, const FaceList& faces,
                 std::span<const Vec3> positions, const RefineOptions& refine);

/// Distortion of an atlas, faces cut into fans of triangles.
struct AtlasDistortion {
  DistortionSummary all;
  std::vector<DistortionSummary> charts;
};

/// @param positions  n, of the graph's vertices, world units
/// @throws InvalidArgument (faces and atlas do not fit, indices)
AtlasDistortion distortion(const Atlas& atlas, const FaceList& faces, std::span<const Vec3> positions);

/// Bounding rectangle of least area of a chart, as axes in its plane: turned by `turn`, the chart fills
/// [low, high] in both directions.
struct ChartBox {
  Vec2 turn{1, 0};  ///< cosine and sine; x = c u + s v, y = -s u + c v
  Vec2 low{}, high{};
};

/// One per chart; the longer side lies along x.
/// @throws InvalidArgument (faces and atlas do not fit)
std::vector<ChartBox> chart_boxes(const Atlas& atlas, const FaceList& faces);

struct PackOptions {
  int size = 2048;  ///< texels of a side of the square; 16 to 32768
  int margin = 4;   ///< texels kept free around each chart, and at the border of the square; >= 0
};

/// Where a chart lies, in texels from the lower left corner of the square, its margin not included.
struct TextureBox {
  int x, y, width, height;
};

struct TextureAtlas {
  int size = 0, margin = 0;
  double scale = 0;                 ///< texels per world unit, the same for all charts
  double filled = 0;                ///< share of the square that the boxes of the charts take
  std::vector<TextureBox> boxes;    ///< one per chart; they do not touch, nor do their margins overlap
  std::vector<double> coordinates;  ///< corners x 2 in [0, 1], (0, 0) the lower left corner; NaN without a chart
};

/// Whether this build can pack (needs stb).
bool can_pack() noexcept;

/// Turns every chart into its rectangle of least area and packs the rectangles as large as they fit (stb_rect_pack),
/// all lying or all standing, at one scale.
/// @throws InvalidArgument (options; no room for so many charts), Error (built without stb)
TextureAtlas pack(const Atlas& atlas, const FaceList& faces, const PackOptions& options = {});

/// Squares of equal size in every chart, along its box, in a hue of its own; margins are painted like their chart.
/// @param square  side in texels; 0: 64 along the side of the texture
Image checkerboard(const TextureAtlas& atlas, int square = 0);

}  // namespace ahm
