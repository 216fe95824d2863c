/// \file
/// Any surface as polygons: what textures lie on. Clouds become triangles.
///
/// \code
/// ahm::SurfaceFaces faces = ahm::surface_faces(surface, solver, sources);
/// ahm::Atlas atlas = ahm::make_atlas(solver, sources, faces.of_vertices());
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

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

}  // namespace ahm
