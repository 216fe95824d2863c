/// \file
/// Frames at a source in space.
#pragma once

#include "ahm/tangent_graph.hpp"

namespace ahm::app {

/// The frame whose x axis is `direction` projected to the tangent plane.
Frame turned(const Frame& frame, const Vec3& direction);

}  // namespace ahm::app
