/// \file
/// Union of the Delaunay triangles of all points, each in its own tangent plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloud_parts.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Triangulates the neighbors of each point, projected to its tangent plane, and keeps the triangles at the point itself. Lists a
/// triangle found at several of its corners once. Corners ascend, and triangles are in lexicographic order.
/// @param oriented  1 where neighbors with opposed normals are rejected
/// @param noise     standard deviation of offsets across the surface; neighbors far beyond it, steeply above the surface, are
///                  rejected
/// @param inner     output, may be null: for each point, whether its triangles surround it
/// @param votes     output, may be null: for each triangle, the number of corners at which it was found
std::vector<Triangle> local_delaunay(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     const TangentPlanes& planes, const PerPart& oriented, const PerPart& noise,
                                     const CloudOptions& options, CloudDetails& report,
                                     std::vector<char>* inner = nullptr, std::vector<std::uint8_t>* votes = nullptr);

}  // namespace ahm::pointcloud
