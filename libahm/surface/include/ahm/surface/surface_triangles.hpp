/// \file
/// Triangles and normals of a graph without faces.
///
/// \code
/// ahm::LogMap map = solver.solve(source, {.frames = true});
/// std::vector<ahm::Triangle> triangles = ahm::star_triangles(graph, map);   // of the graph's vertices
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/half_edges.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Triangles of the graph itself, for clouds and other surfaces without faces. A triangle is a vertex with two neighbors that
/// follow each other in angle, less than 180 degrees apart. The two must be neighbors of each other, or have another common
/// neighbor (the fourth corner of a quadrilateral). Triangles are counterclockwise as seen from the source's side, appear once,
/// and use only vertices with coordinates. Holes of one triangle or quadrilateral are closed.
/// @throws InvalidArgument (dimension, no frames in the map, another graph's map)
std::vector<Triangle> star_triangles(const TangentGraph& graph, const LogMap& map);

/// The normal of every vertex on the side of the source. It is reversed where transport from the source mirrors the vertex's
/// frame. n entries; NaN where the map is not ok.
/// @throws InvalidArgument (dimension, no frames in the map or the graph, another graph's map)
std::vector<Vec3> source_side_normals(const TangentGraph& graph, const LogMap& map);

/// Polygons, oriented consistently where possible.
struct SurfaceFaces {
  std::vector<Vec3> points, normals;   ///< of the rows of a mesh or the vertices of a cloud's graph; world units
  std::vector<Offset> begin{0};        ///< faces + 1
  std::vector<Index> corner_points;    ///< index into `points` of every corner
  std::vector<Index> corner_vertices;  ///< vertex of the graph at every corner

  FaceList of_vertices() const { return {begin, corner_vertices}; }
};

/// The faces of the input. Without faces: the `star_triangles` of a map from the sources, oriented to the sources' side.
/// @param sources  used without faces: at least one per component to be covered; only the first of each component is used
/// @throws InvalidArgument, without faces: as `LogMapSolver::solve`, `star_triangles`
SurfaceFaces surface_faces(const Surface& surface, const LogMapSolver& solver, std::span<const Vertex> sources);
SurfaceFaces surface_faces(const Surface& surface, const PolarMapSolver& solver, std::span<const Vertex> sources);

/// The faces of the input; empty for clouds.
SurfaceFaces surface_faces(const Surface& surface);

/// The faces of a mesh as triangles of rows, oriented to agree with the normals of the rows. Polygons are split into fans from
/// their first corner.
std::vector<Triangle> turned_triangles(const Surface& surface, std::span<const Vec3> normals);

/// Positions of the rows in the graph: in noisy clouds the smoothed points. NaN where a row has no vertex, as for points that
/// thinning removed. Drawn together with the remaining points, they would hide them.
/// @return  rows x 3, world units; empty for a surface defined by edge lengths only
std::vector<Vec3> mapped_positions(const Surface& surface);

/// Faces by rows in CSR format: face f has the corners rows[begin[f]] to rows[begin[f + 1] - 1]. Both empty: no faces.
struct RowFaces {
  std::vector<Offset> begin;
  std::vector<Index> rows;
};

/// The triangles of `Surface::flat_approximation` by rows. Empty where more than one vertex in fifty is in no triangle, because
/// those points would not be visible. Empty for a surface with faces.
RowFaces mapped_triangles(const Surface& surface);
}  // namespace ahm

namespace ahm::detail {

/// Faces laid out in planes of their own; one entry per corner, in the stored order.
struct FlatCorners {
  std::span<const Index> vertices;  ///< vertices of the graph
  std::span<const Vec2> places;     ///< in one plane per face, counterclockwise, in units of `unit`; NaN: no face
  double unit = 1;                  ///< world units, a power of two
  bool orientable = true;
};

/// (u, v) at every stored corner, world units. NaN in faces without places and in faces with a corner where the map is not ok.
///
/// A sheet of a map may stretch its faces, but the stretch changes little from face to face. This distinguishes a tear from the
/// stretch in distant parts of a smooth map. The strain of a face is the largest log(mapped length / length) over its sides and
/// its diagonals (c, c + 2). Lengths below half of the longest one are replaced by that half, so that thin faces require no
/// relative accuracy. The strain of the sheet propagates outward from the source over the faces (breadth first). It follows the
/// strain of the faces by at most 0.05 per face.
///
/// A face is torn if its strain exceeds the sheet's by log 2. It is also torn if the map reverses it to a depth of a tenth of
/// its longest side. Heat maps blend the two sheets over a few edges. So a face at most three faces away from a torn one is torn
/// if its strain, or the negative of it, exceeds the sheet's by log 1.4. Shrunk faces elsewhere belong to the sheet: behind
/// saddles all shortest paths coincide at first.
///
/// A torn face is laid out rigidly next to the nearest face that is not torn, counted in faces. A corner takes its position in
/// another neighboring face where the two positions differ by at most 0.2 of the shortest side.
std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map);

}  // namespace ahm::detail
