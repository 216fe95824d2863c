// The default view direction: towards the source, from a side where nothing stands before it and, of these, as little
// without a map as possible before the map.
#pragma once

#include "camera.hpp"

namespace ahm::render {

/// From the picture's center towards the camera. `extent`: sides of the scene's box, world units.
Eigen::Vector3d choose_direction(const Scene& scene, const std::vector<Index>& shown, const Camera& camera,
                                 const Eigen::Vector3d& up, const Eigen::Vector3d& extent);

}  // namespace ahm::render
