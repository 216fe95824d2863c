/// \file
/// The manifold triangulation of a cloud laid out by the lengths of its edges.
#pragma once

#include <span>

#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/graph/tangent_graph.hpp"

namespace ahm::pointcloud {

/// @param triangles  of a manifold, of vertices of the graph; each vertex has one fan or none
/// @param noise      per vertex, of offsets across the surface, in units of the graph
FlatTriangles flat_sheet(const TangentGraph& graph, std::span<const Triangle> triangles, std::span<const double> noise);

}  // namespace ahm::pointcloud
