// The default view direction: an unobstructed view of the source; among such views, one in which unmapped parts hide as little as
// possible of the map.
#pragma once

#include "camera.hpp"

namespace ahm::render {

/// Direction from the center of the picture to the camera.
/// @param extent  side lengths of the scene's bounding box, world units
Eigen::Vector3d choose_direction(const Scene& scene, const std::vector<Index>& shown, const Camera& camera,
                                 const Eigen::Vector3d& up, const Eigen::Vector3d& extent);

}  // namespace ahm::render
