/// \file
/// The union of every point's Delaunay triangles in its own tangent plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloud_parts.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Triangulates the neighbours of each point, projected to its tangent plane, and keeps the triangles at the point
/// itself. A triangle found from several of its corners is listed once, corners ascending, triangles in lexicographic
/// order.
/// @param oriented  1 where neighbours whose normals point the other way are rejected
/// @param noise  of offsets across the surface; neighbours far beyond it, steeply above the surface, are rejected
/// @param inner  filled, unless it is null: of each point, whether its triangles go all around it
/// @param votes  filled, unless it is null: of each triangle, at how many of its corners it was found
std::vector<Triangle> local_delaunay(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     const TangentPlanes& planes, const PerPart& oriented, const PerPart& noise,
                                     const CloudOptions& options, CloudDetails& report,
                                     std::vector<char>* inner = nullptr, std::vector<std::uint8_t>* votes = nullptr);

}  // namespace ahm::pointcloud
