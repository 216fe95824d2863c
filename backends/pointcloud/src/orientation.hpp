/// \file
/// Consistent signs for the normals of a cloud.
#pragma once

#include <vector>

#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// Whether given normals can be trusted in sign. They can when at most a quarter of the pairs of neighbours with nearly
/// parallel planes disagree, or when those that disagree lie consistently behind, or before, each other: two sheets of
/// a thin wall.
bool signs_agree(const CleanPoints& cloud, const TangentPlanes& planes, const Neighborhoods& neighborhoods);

/// Flips normals so that they agree along a spanning tree of the flattest edges, per connected component. The component
/// as a whole keeps the majority of the signs that were given, else points away from its centroid, else (flat clouds)
/// along its largest coordinate.
void orient_normals(const CleanPoints& cloud, const WeightedEdges& edges, bool signs_given, TangentPlanes& planes);

}  // namespace ahm::pointcloud
