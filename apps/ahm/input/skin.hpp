/// \file
/// The surface as polygons: what textures lie on, and what carries coordinates back to space.
#pragma once

#include <span>
#include <vector>

#include "ahm/applications/atlas.hpp"
#include "ahm/applications/inverse_map.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Polygons, all oriented alike where that is possible.
struct Skin {
  std::vector<Vec3> points, normals;   ///< the rows of a mesh, or the vertices of a cloud's graph
  std::vector<Offset> face_begin{0};   ///< faces + 1
  std::vector<Index> corner_points;    ///< place in `points` of every corner
  std::vector<Index> corner_vertices;  ///< vertex of the graph of every corner
  FaceList faces() const { return {face_begin, corner_vertices}; }
};

/// The faces of the input; for clouds the triangles of `star_triangles`, as a map from the sources finds them.
/// @param sources  vertices, at most one per component counts
Skin skin_of(const Input& input, const LogMapSolver& solver, std::span<const Vertex> sources);

/// The inverse of a map with frames: for meshes on the rows and faces of the input, so that points lie on them whatever
/// the graph looks like (of several vertices of a row the one nearest to the source counts), for clouds on the graph.
InverseMap inverse_of(const Input& input, const LogMap& map, double min_quality);

}  // namespace ahm::app
