/// \file
/// A manifold triangulation of a cloud, chosen from the union of the local Delaunay triangulations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm::pointcloud {

/// The union of the local Delaunay triangulations.
struct LocalTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> votes;  ///< per triangle: number of corners that have it in their own triangulation, 1 to 3
};

/// Adds triangles in the order of their votes, and those with fewer than three votes in the order of their size. Skips
/// triangles that overlap an earlier one in the tangent plane of a corner. Fills small holes. In the result every edge has at
/// most two triangles, and every vertex has one fan or none. Time O(n log n).
/// @param frames  frames of the points, in any unit of length; normals of neighbors should agree on the upper side
std::vector<Triangle> sheet_triangles(std::span<const Frame> frames, const LocalTriangles& candidates);

/// The polyhedral surface of these triangles. Edge lengths are distances of the points; the unfolded edges of the graph differ
/// more from those of a mesh.
/// @param frames     frames of the vertices of the graph, in units of `length_unit`
/// @param triangles  triangles of a manifold; each vertex has one fan or none
FlatTriangles flat_sheet(std::span<const Frame> frames, std::span<const Triangle> triangles, double length_unit);

}  // namespace ahm::pointcloud
