/// \file
/// Moving least squares: noisy points move onto quadrics fitted to their neighbors.
#pragma once

#include <vector>

#include "noisy_planes.hpp"

namespace ahm::pointcloud {

/// Which parts are noisy surfaces: neighbors' offsets deviate by more than a share of the spacing. With a radius of the caller all
/// are, with smoothing turned off none.
std::vector<char> find_noisy_parts(const CleanPoints& cloud, const NoisyPlanes& planes, const NeighborSearch& search,
                                   const CloudOptions& options);

/// Moves the points of noisy parts along the normals of their planes, and marks them in `cloud.smoothed`: where the noise of the
/// neighborhood is large; with a radius of the caller everywhere.
/// A point leaves out neighbors in other sheets, and stays where it is if too few remain or the quadric is far off.
/// @param planes  of these points
/// @return whether a point moved
bool smooth_points(CleanPoints& cloud, const NoisyPlanes& planes, const std::vector<char>& noisy_parts,
                   const NeighborSearch& search, const CloudOptions& options);

}  // namespace ahm::pointcloud
