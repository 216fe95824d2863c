/// \file
/// The manifold triangulation of a cloud as flat triangles.
#pragma once

#include <span>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm::pointcloud {

/// Lengths are distances of the points: unfolded edges of the graph are farther from those of a mesh.
/// @param frames     of the vertices of the graph, in units of `length_unit`
/// @param triangles  of a manifold; each vertex has one fan or none
FlatTriangles flat_sheet(std::span<const Frame> frames, std::span<const Triangle> triangles, double length_unit);

}  // namespace ahm::pointcloud
