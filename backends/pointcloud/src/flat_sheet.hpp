/// \file
/// The manifold triangulation of a cloud as flat triangles.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm::pointcloud {

/// Lengths are distances of the points: unfolded edges of the graph are farther from those of a mesh.
/// @param graph      with frames, whose origins are the points
/// @param triangles  of a manifold, of vertices of the graph; each vertex has one fan or none
FlatTriangles flat_sheet(const TangentGraph& graph, std::span<const Triangle> triangles);

}  // namespace ahm::pointcloud
