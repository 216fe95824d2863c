/// \file
/// A manifold triangulation of a cloud, chosen from the union of the local Delaunay triangulations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm::pointcloud {

/// Triangles of the union, and how many of their corners have them in their own triangulation.
struct LocalTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> votes;  ///< per triangle, 1 to 3
};

/// Takes the triangles in the order of their votes, disputed ones then of their size, where they overlap none taken before in the tangent planes
/// of their corners. Small holes that are left are filled. Every edge of the result has at most two triangles, every vertex one
/// fan or none. Time O(n log n).
/// @param frames  of the points, in any unit of length; neighbors' normals should agree on the side
std::vector<Triangle> sheet_triangles(std::span<const Frame> frames, const LocalTriangles& candidates);

/// Lengths are distances of the points: unfolded edges of the graph are farther from those of a mesh.
/// @param frames     of the vertices of the graph, in units of `length_unit`
/// @param triangles  of a manifold; each vertex has one fan or none
FlatTriangles flat_sheet(std::span<const Frame> frames, std::span<const Triangle> triangles, double length_unit);

}  // namespace ahm::pointcloud
