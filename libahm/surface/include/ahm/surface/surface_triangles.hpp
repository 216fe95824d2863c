/// \file
/// Triangles and normals of a graph that has no faces of its own.
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

/// Triangles of the graph itself, for clouds and whatever else has no faces: each vertex with two neighbours that follow
/// each other in angle, less than 180 degrees apart, and are neighbours or have another common neighbour (the fourth
/// corner of a quadrilateral). Counter-clockwise as seen from the source's side, each once; between vertices with
/// coordinates only. A hole as small as one triangle or quadrilateral is closed.
/// @throws InvalidArgument (dimension, no frames in the map, another graph's map)
std::vector<Triangle> star_triangles(const TangentGraph& graph, const LogMap& map);

/// The normal of every vertex on the side of the source: turned over where the way from the source mirrors the vertex's
/// frame. n; NaN where the map is not ok.
/// @throws InvalidArgument (dimension, no frames in the map or the graph, another graph's map)
std::vector<Vec3> source_side_normals(const TangentGraph& graph, const LogMap& map);

/// Polygons, all oriented alike where that is possible.
struct SurfaceFaces {
  std::vector<Vec3> points, normals;   ///< the rows of a mesh, or the vertices of a cloud's graph; world units
  std::vector<Offset> begin{0};        ///< faces + 1
  std::vector<Index> corner_points;    ///< place in `points` of every corner
  std::vector<Index> corner_vertices;  ///< vertex of the graph of every corner

  FaceList of_vertices() const { return {begin, corner_vertices}; }
};

/// The faces of the input; without faces the triangles of `star_triangles`, on the side that a map from the sources sees.
/// @param sources  without faces: at least one for every component to be covered; at most one of each counts
/// @throws InvalidArgument, without faces: as `LogMapSolver::solve`, `star_triangles`
SurfaceFaces surface_faces(const Surface& surface, const LogMapSolver& solver, std::span<const Vertex> sources);
SurfaceFaces surface_faces(const Surface& surface, const PolarMapSolver& solver, std::span<const Vertex> sources);

/// The faces of the input; none of a cloud.
SurfaceFaces surface_faces(const Surface& surface);

/// The faces of a mesh as triangles of rows, turned to the side of given normals of the rows; polygons as fans from their
/// first corner.
std::vector<Triangle> turned_triangles(const Surface& surface, std::span<const Vec3> normals);

/// Where the graph has the rows: in a cloud with noise the smoothed points. NaN where a row has no vertex: in a cloud that was
/// thinned, all but the points that stand for the others. Drawn beside these, the others would hide them.
/// @return  rows x 3, world units; empty for a surface given by lengths alone
std::vector<Vec3> mapped_positions(const Surface& surface);

/// The triangles of `Surface::flat_approximation` by their rows, where at most one vertex in fifty is in none of them; else none: these
/// points would not be seen. None for a surface with faces.
std::vector<Triangle> mapped_triangles(const Surface& surface);
}  // namespace ahm

namespace ahm::detail {

/// Faces as they lie in planes of their own, per corner as stored.
struct FlatCorners {
  std::span<const Index> vertices;  ///< of the graph
  std::span<const Vec2> places;     ///< in a plane per face, counter-clockwise, in units of `unit`; NaN: no face
  double unit = 1;                  ///< world units, a power of two
  bool orientable = true;
};

/// (u, v) at every corner as stored, world units; NaN in faces with a corner where the map is not ok, or without places.
///
/// One sheet of a map may stretch its faces, but from face to face this changes little: so a tear is told from the stretch of the
/// distant part of a smooth map. Of a face, compared are its sides and diagonals (c, c + 2): its strain is the largest
/// log(mapped length / length), those shorter than half of the longest counting as that half, so that no map needs relative
/// accuracy on thin faces. Going outward from the source over the faces (breadth first) the sheet's strain follows that of its
/// faces by 0.05 a face at the most.
///
/// A face is torn whose strain exceeds the sheet's by log 2, or which is turned over, to a depth of a tenth of its longest side. In
/// maps by heat, which blend the two sheets over a few edges, torn are also faces up to three away from such a one whose strain,
/// or its opposite, exceeds the sheet's by log 1.4. Shrunk faces elsewhere are on the sheet: behind saddles all shortest paths are
/// the same at first. Torn faces are laid out beside the nearest face, counted in faces, that is not: rigidly, but for corners that
/// other neighbours have no farther away than 0.2 of the shortest side.
std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map);

}  // namespace ahm::detail
