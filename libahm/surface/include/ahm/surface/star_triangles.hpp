/// \file
/// Triangles and normals of a graph that has no faces of its own.
///
/// \code
/// ahm::LogMap map = solver.solve(source, {.frames = true});
/// std::vector<ahm::Triangle> triangles = ahm::star_triangles(graph, map);   // of the graph's vertices
/// \endcode
#pragma once

#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"

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

}  // namespace ahm
