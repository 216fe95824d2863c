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
