/// \file
/// Consistent signs for the normals of a cloud.
#pragma once

#include <vector>

#include "tangent_planes.hpp"
#include "tufted_cover.hpp"

namespace ahm::pointcloud {

/// Whether neighbours of opposite normals are the two sheets of thin walls: they lie consistently behind, or before, each
/// other. Normals whose signs are wrong, or turned to a viewpoint, show no such thing: what curvature does to one side of
/// a pair it undoes on the other, and noise has no direction.
bool have_thin_walls(const CleanPoints& cloud, const TangentPlanes& planes, const Neighborhoods& neighborhoods);

/// Flips normals so that they agree along a spanning tree of the flattest edges [HDDMS92], per connected component.
/// The component as a whole keeps the majority of the signs that were given, else points away from its centroid, else
/// (flat clouds) along its largest coordinate.
/// @return the number of normals that are flipped against the majority of their component
Index orient_normals(const CleanPoints& cloud, const WeightedEdges& edges, bool signs_given, TangentPlanes& planes);

}  // namespace ahm::pointcloud
