/// \file
/// Frames at a source in space.
#pragma once

#include "ahm/graph/tangent_graph.hpp"

namespace ahm::app {

/// The frame whose x axis is `direction` projected to the tangent plane.
Frame turned(const Frame& frame, const Vec3& direction);

/// Direction in space along which the surface bends most at a vertex.
/// @throws InvalidArgument where it bends alike in all directions, where the neighbours' directions contradict each
/// other, and where there are too few neighbours to tell
Vec3 bending_direction(const TangentGraph& graph, Vertex vertex);

}  // namespace ahm::app
