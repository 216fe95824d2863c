/// \file
/// Polygons in their planes.
#pragma once

#include <vector>

#include "ahm/polymesh/polygon_mesh.hpp"

namespace ahm::polymesh {

/// Per corner as stored: its place in the plane perpendicular to the face's vector area, from the first corner, the first side
/// along the x axis, counter-clockwise; in units of `length_unit`. A face without area lies along that axis.
std::vector<Vec2> flat_faces(const PolygonMesh& mesh);

}  // namespace ahm::polymesh
